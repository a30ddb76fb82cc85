#include <algorithm>
#include <set>
#include <string>

#include <quantize/motorcycle_complex.hpp>

#include <base/disjoint_sets.hpp>

namespace hexhex {

namespace {

/// By this power of two, on the lattice of 2^52 units, thicknesses have to differ to matter.
constexpr int kThicknessBits = 28;

/// Where blocks do not close up: a way around through which charts differ.
struct Holonomy {
  Index tet = kNone;   ///< where it was noticed
  ChartChange change;  ///< of the block's chart
};

/// Numbers the parts between walls, each in one chart.
Holonomy findBlocks(MotorcycleComplex& complex) {
  const WallMesh& mesh = complex.mesh;
  complex.blockOf.assign(mesh.tetCount(), kNone);
  complex.toBlock.assign(mesh.tetCount(), {});
  complex.blockCount = 0;
  Holonomy holonomy;
  std::vector<Index> queue;
  for (Index root = 0; root < mesh.tetCount(); ++root) {
    if (complex.blockOf[root] != kNone) continue;
    const auto block = static_cast<Index>(complex.blockCount++);
    complex.blockOf[root] = block;
    queue.assign(1, root);
    for (std::size_t next = 0; next < queue.size(); ++next) {
      for (int face = 0; face < 4; ++face) {
        const HalfFace h = halfFaceOf(queue[next], face);
        if (mesh.isWall[h]) continue;
        const Index there = tetOf(mesh.mate[h]);
        const ChartChange way = complex.toBlock[queue[next]] * mesh.change[h].inverse();
        if (complex.blockOf[there] == kNone) {
          complex.blockOf[there] = block;
          complex.toBlock[there] = way;
          queue.push_back(there);
        } else if (holonomy.tet == kNone && !(way == complex.toBlock[there])) {
          holonomy = {there, way * complex.toBlock[there].inverse()};
        }
      }
    }
  }
  return holonomy;
}

/// A directed edge of a wall's triangle.
struct WallEdge {
  std::array<Index, 2> key{};  ///< ascending
  Index tail = 0;
  Index head = 0;
  HalfFace halfFace = 0;
  [[nodiscard]] auto operator<=>(const WallEdge&) const = default;
};

std::vector<WallEdge> wallEdges(const WallMesh& mesh) {
  std::vector<WallEdge> edges;
  for (HalfFace h = 0; h < mesh.mate.size(); ++h) {
    if (!mesh.isWall[h]) continue;
    const auto& c = kFaceCorners[h % 4];
    const Tet& tet = mesh.tets[tetOf(h)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index tail = tet[static_cast<std::size_t>(c[k])];
      const Index head = tet[static_cast<std::size_t>(c[(k + 1) % 3])];
      edges.push_back({{std::min(tail, head), std::max(tail, head)}, tail, head, h});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// The complex's edges, and which arc each belongs to.
class ArcFinder {
 public:
  ArcFinder(MotorcycleComplex& complex, DisjointSets& sides) : complex_(complex), sides_(sides) {}

  /// Finds the complex's edges, and joins sides of triangles that lie in one plane.
  void collect() {
    const std::vector<WallEdge> edges = wallEdges(complex_.mesh);
    forEachRun(
        std::span<const WallEdge>(edges),
        [](const WallEdge& a, const WallEdge& b) { return a.key == b.key; },
        [this](std::span<const WallEdge> same) { addEdge(same); });
    linkEdges();
  }

  /// Numbers arcs. After collect().
  void follow() {
    for (Index edge = 0; edge < edges_.size(); ++edge) {
      for (const bool fromHead : {false, true}) {
        const Index start = edges_[edge].vertices[fromHead ? 1 : 0];
        if (isNode(start) && edges_[edge].arc == kNone) follow(edge, start);
      }
    }
    for (const Edge& edge : edges_) {
      if (edge.arc == kNone) {
        throw Error(ErrorCode::Internal, "An arc of the motorcycle complex has no nodes.",
                    {PlaceKind::Edge, edge.vertices[0], edge.vertices[1]});
      }
    }
  }

  [[nodiscard]] bool isNode(Index vertex) const {
    if (edgesAt_[vertex].empty()) return false;
    return edgesAt_[vertex].size() != 2 || complex_.mesh.featureVertices.contains(vertex);
  }

  /// How a directed edge lies in its arc: the arc, and whether it goes the arc's way; how far from
  /// the arc's first node it begins.
  struct Position {
    Index arc = kNone;  ///< kNone: not an edge of the complex
    bool isForward = true;
    std::int64_t offset = 0;  ///< of its tail, along the arc
  };
  [[nodiscard]] Position positionOf(Index tail, Index head) const {
    const auto found = byKey_.find({std::min(tail, head), std::max(tail, head)});
    if (found == byKey_.end()) return {};
    const Edge& edge = edges_[found->second];
    const bool isForward = edge.first == tail;
    return {edge.arc, isForward, isForward ? edge.offset : edge.offset + edge.length};
  }

 private:
  struct Edge {
    std::array<Index, 2> vertices{};
    std::int64_t length = 0;
    Index arc = kNone;
    Index first = kNone;      ///< its end that is nearer to the arc's first node
    std::int64_t offset = 0;  ///< of that end
  };

  /// An edge with all triangles of walls at it.
  void addEdge(std::span<const WallEdge> same) {
    const WallMesh& mesh = complex_.mesh;
    std::size_t triangles = 0;
    for (const WallEdge& each : same) {
      const HalfFace mate = mesh.mate[each.halfFace];
      triangles += mate == kNone || each.halfFace < mate ? 1 : 0;
    }
    if (triangles == 2 && joinIfFlat(same)) return;
    const Index tet = tetOf(same[0].halfFace);
    const LatticePoint along = mesh.at(tet, mesh.cornerOf(tet, same[0].key[1])) -
                               mesh.at(tet, mesh.cornerOf(tet, same[0].key[0]));
    Edge edge;
    edge.vertices = same[0].key;
    for (const std::int64_t x : along) edge.length += std::abs(x);
    byKey_.emplace(edge.vertices, static_cast<Index>(edges_.size()));
    edges_.push_back(edge);
  }

  /// Of two triangles at an edge: joins them if they lie in a plane.
  bool joinIfFlat(std::span<const WallEdge> same) {
    for (const WallEdge& each : same) {
      const HalfFace other = wallOpposite(complex_.mesh, each.halfFace, each.tail, each.head);
      if (other == kNone || sameTriangle(each.halfFace, other)) return false;
    }
    for (const WallEdge& each : same) {
      sides_.unite(each.halfFace, wallOpposite(complex_.mesh, each.halfFace, each.tail, each.head));
    }
    return true;
  }
  [[nodiscard]] bool sameTriangle(HalfFace a, HalfFace b) const {
    return a == b || complex_.mesh.mate[a] == b;
  }

  void linkEdges() {
    edgesAt_.resize(complex_.mesh.vertexCount());
    for (Index e = 0; e < edges_.size(); ++e) {
      for (const Index v : edges_[e].vertices) edgesAt_[v].push_back(e);
    }
  }
  /// Numbers the arc that begins with an edge.
  void follow(Index edge, Index start) {
    Arc arc;
    arc.nodes[0] = start;
    Index vertex = start;
    while (true) {
      Edge& here = edges_[edge];
      here.arc = static_cast<Index>(complex_.arcs.size());
      here.first = vertex;
      here.offset = arc.length;
      arc.length += here.length;
      arc.isFeature = arc.isFeature || complex_.mesh.featureEdges.contains(here.vertices);
      vertex = here.vertices[0] == vertex ? here.vertices[1] : here.vertices[0];
      if (isNode(vertex)) break;
      edge = edgesAt_[vertex][0] == edge ? edgesAt_[vertex][1] : edgesAt_[vertex][0];
    }
    arc.nodes[1] = vertex;
    complex_.arcs.push_back(arc);
  }

  MotorcycleComplex& complex_;
  DisjointSets& sides_;
  std::vector<Edge> edges_;
  std::map<std::array<Index, 2>, Index> byKey_;
  std::vector<std::vector<Index>> edgesAt_;
};

/// Cuts a block that returns to itself, and is no box, across.
void cutAcross(MotorcycleComplex& complex, const Holonomy& holonomy) {
  // Along the axis that the way around returns to, moved.
  const Rotation turn = holonomy.change.rotation;
  std::size_t axis = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    const Direction d = direction(static_cast<int>(k), 1);
    if (turn(d) == d && holonomy.change.translation[k] != 0) axis = k;
  }
  const Index block = complex.blockOf[holonomy.tet];
  if (axis == 3) {
    throw Error(ErrorCode::TransitionResidual,
                "A part of the map returns to itself turned over; it has no motorcycle complex.",
                {PlaceKind::Tet, complex.mesh.original[holonomy.tet]});
  }
  // Through a node, so that no short arcs arise, and a tet that reaches to both sides of it.
  WallMesh& mesh = complex.mesh;
  DisjointSets sides(mesh.mate.size());
  ArcFinder arcs(complex, sides);
  arcs.collect();
  std::vector<Index> tets;
  std::int64_t value = complex.toBlock[holonomy.tet](mesh.at(holonomy.tet, 0))[axis];
  for (Index t = 0; t < mesh.tetCount(); ++t) {
    if (complex.blockOf[t] != block) continue;
    tets.push_back(t);
    for (std::size_t i = 0; i < 4; ++i) {
      if (arcs.isNode(mesh.tets[t][i])) value = complex.toBlock[t](mesh.at(t, i))[axis];
    }
  }
  // The chart is unrolled somewhere: the plane may lie one way around from there.
  WallTracer tracer(mesh);
  const std::int64_t around = holonomy.change.translation[axis];
  for (const std::int64_t shift : {std::int64_t{0}, around, -around}) {
    const AxisPlane plane{axis, value + shift};
    const auto found = std::find_if(tets.begin(), tets.end(), [&](Index t) {
      return tracer.startIn(t, plane.beyond(complex.toBlock[t].inverse()));
    });
    if (found == tets.end()) continue;
    tracer.grow();
    return;
  }
  throw Error(ErrorCode::Internal, "A ring of the motorcycle complex cannot be cut. This is a bug.",
              {PlaceKind::Tet, mesh.original[holonomy.tet]});
}

/// The sides of patches, with their borders.
class PatchFinder {
 public:
  PatchFinder(MotorcycleComplex& complex, const ArcFinder& arcs, DisjointSets& sides)
      : complex_(complex), arcs_(arcs), sides_(sides) {}

  void run() {
    const WallMesh& mesh = complex_.mesh;
    complex_.patchOf.assign(mesh.mate.size(), kNone);
    for (HalfFace h = 0; h < mesh.mate.size(); ++h) {
      if (mesh.isWall[h]) addTriangle(h);
    }
    for (std::size_t p = 0; p < borders_.size(); ++p) {
      complex_.patches[p].border.assign(borders_[p].begin(), borders_[p].end());
    }
  }

 private:
  void addTriangle(HalfFace h) {
    const HalfFace first = sides_.find(h);
    if (first == h) {
      complex_.patchOf[h] = static_cast<Index>(complex_.patches.size());
      complex_.patches.push_back({complex_.blockOf[tetOf(h)], h, {}});
      borders_.emplace_back();
    }
    complex_.patchOf[h] = complex_.patchOf[first];
    const auto& c = kFaceCorners[h % 4];
    for (std::size_t k = 0; k < 3; ++k) {
      addEdge(h, static_cast<std::size_t>(c[k]), static_cast<std::size_t>(c[(k + 1) % 3]));
    }
  }

  /// A directed edge of a triangle, if it is one of an arc.
  void addEdge(HalfFace h, std::size_t tail, std::size_t head) {
    const Index tet = tetOf(h);
    const WallMesh& mesh = complex_.mesh;
    const auto at = arcs_.positionOf(mesh.tets[tet][tail], mesh.tets[tet][head]);
    if (at.arc == kNone) return;
    const LatticePoint from = complex_.toBlock[tet](mesh.at(tet, tail));
    const LatticePoint along = complex_.toBlock[tet](mesh.at(tet, head)) - from;
    ArcSide side;
    side.arc = at.arc;
    while (along[side.axis] == 0) ++side.axis;
    side.sign = along[side.axis] > 0 ? 1 : -1;
    // The arc's node from which the side comes lies this far behind.
    const std::int64_t length = complex_.arcs[at.arc].length;
    const std::int64_t behind = at.isForward ? at.offset : length - at.offset;
    side.start = side.end = from;
    side.start[side.axis] -= side.sign * behind;
    side.end[side.axis] += side.sign * (length - behind);
    borders_[complex_.patchOf[h]].insert(side);
    for (const std::size_t corner : {tail, head}) addFeature(tet, corner, side);
  }

  void addFeature(Index tet, std::size_t corner, const ArcSide& side) {
    const Index vertex = complex_.mesh.tets[tet][corner];
    const bool isNode = arcs_.isNode(vertex) && complex_.mesh.featureVertices.contains(vertex);
    if (!isNode && !complex_.arcs[side.arc].isFeature) return;
    const LatticePoint here = complex_.toBlock[tet](complex_.mesh.at(tet, corner));
    complex_.featureCorners.push_back(
        {tet, corner, isNode ? 3 : std::size_t{side.axis}, isNode ? here : side.start});
  }

  MotorcycleComplex& complex_;
  const ArcFinder& arcs_;
  DisjointSets& sides_;
  std::vector<std::set<ArcSide>> borders_;
};

void findArcsAndPatches(MotorcycleComplex& complex) {
  complex.arcs.clear();
  complex.patches.clear();
  complex.featureCorners.clear();
  DisjointSets sides(complex.mesh.mate.size());
  ArcFinder arcs(complex, sides);
  arcs.collect();
  arcs.follow();
  PatchFinder(complex, arcs, sides).run();
}

/// From the lowest corner to the highest one.
struct Extent {
  LatticePoint low{};
  LatticePoint high{};
  bool isEmpty = true;

  void add(const LatticePoint& point) {
    if (isEmpty) low = high = point;
    isEmpty = false;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
  void add(const PatchSide& patch) {
    for (const ArcSide& side : patch.border) add(side.start);
  }
};

/// Takes away walls between two blocks that are one box without it: arcs that nothing needs would
/// only demand hexahedra (the reduced complex of Brueckner et al.). Thin blocks go first.
class WallRemover {
 public:
  explicit WallRemover(MotorcycleComplex& complex)
      : complex_(complex), blocks_(complex.blockCount), isFeature_(complex.patches.size()) {
    for (const PatchSide& patch : complex.patches) blocks_[patch.block].add(patch);
    for (HalfFace h = 0; h < complex.patchOf.size(); ++h) {
      if (complex.mesh.isFeature[h]) isFeature_[complex.patchOf[h]] = true;
    }
    for (Index p = 0; p < complex.patches.size(); ++p) {
      for (const ArcSide& side : complex.patches[p].border) {
        if (complex.arcs[side.arc].isFeature) isFeature_[p] = true;
      }
    }
  }

  /// @return whether there were any
  bool run() {
    std::vector<std::pair<std::int64_t, Index>> removable;
    for (Index p = 0; p < complex_.patches.size(); ++p) {
      const std::int64_t thick = thicknessBeside(p);
      // Without noise that would decide in symmetric maps.
      if (thick > 0) removable.emplace_back(thick >> kThicknessBits, p);
    }
    std::sort(removable.begin(), removable.end());
    std::vector<bool> isChanged(complex_.blockCount);
    std::vector<bool> isRemoved(complex_.patches.size());
    for (const auto& [thick, p] : removable) {
      const Index other = complex_.acrossPatch(p);
      const Index a = complex_.patches[p].block;
      const Index b = complex_.patches[other].block;
      if (isChanged[a] || isChanged[b]) continue;
      isChanged[a] = isChanged[b] = true;
      isRemoved[p] = isRemoved[other] = true;
    }
    for (HalfFace h = 0; h < complex_.patchOf.size(); ++h) {
      const Index p = complex_.patchOf[h];
      if (p != kNone && isRemoved[p]) complex_.mesh.isWall[h] = false;
    }
    return !removable.empty();
  }

 private:
  /// Of the thinner block beside a wall that may go, otherwise 0.
  [[nodiscard]] std::int64_t thicknessBeside(Index p) const {
    const Index other = complex_.acrossPatch(p);
    if (other == kNone || other < p || isFeature_[p]) return 0;
    const PatchSide& here = complex_.patches[p];
    const PatchSide& there = complex_.patches[other];
    if (here.block == there.block) return 0;
    return std::min(thickness(here), thickness(there));
  }
  /// How thick a block is behind a patch that is a whole side of it, otherwise 0.
  [[nodiscard]] std::int64_t thickness(const PatchSide& patch) const {
    Extent own;
    own.add(patch);
    const LatticePoint size = own.high - own.low;
    const LatticePoint whole = blocks_[patch.block].high - blocks_[patch.block].low;
    std::int64_t thick = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (size[k] == 0) {
        thick = whole[k];
      } else if (size[k] != whole[k]) {
        return 0;
      }
    }
    return thick;
  }

  MotorcycleComplex& complex_;
  std::vector<Extent> blocks_;
  std::vector<bool> isFeature_;  ///< per side of a patch: it has to stay
};

/// A block is a box if it has the volume of its bounding box.
void requireBoxes(const MotorcycleComplex& complex) {
  std::vector<Extent> extents(complex.blockCount);
  std::vector<Int192> sixfoldVolumes(complex.blockCount);
  std::vector<Index> someTet(complex.blockCount);
  for (Index t = 0; t < complex.mesh.tetCount(); ++t) {
    const Index block = complex.blockOf[t];
    someTet[block] = t;
    LatticeTet u = complex.mesh.corners[t];
    for (LatticePoint& corner : u) {
      corner = complex.toBlock[t](corner);
      extents[block].add(corner);
    }
    sixfoldVolumes[block] += orientationDeterminant(u[0], u[1], u[2], u[3]);
  }
  for (Index block = 0; block < complex.blockCount; ++block) {
    const LatticePoint size = extents[block].high - extents[block].low;
    Int192 difference = sixfoldVolumes[block];
    difference.addProduct(static_cast<Int128>(size[0]) * size[1], -6 * size[2]);
    if (difference.sign() != 0) {
      throw Error(ErrorCode::Internal,
                  "A block of the motorcycle complex is no box. This is a bug.",
                  {PlaceKind::Tet, complex.mesh.original[someTet[block]]});
    }
  }
}

}  // namespace

MotorcycleComplex traceComplex(const SeamlessMap& map, bool reduced, Context& context) {
  Stage stage(context, "motorcycle complex");
  MotorcycleComplex complex{.mesh = traceWalls(map, EdgeFans(map.topology))};
  for (Holonomy ring = findBlocks(complex); ring.tet != kNone; ring = findBlocks(complex)) {
    context.throwIfCancelled();
    cutAcross(complex, ring);
  }
  requireBoxes(complex);
  findArcsAndPatches(complex);
  while (reduced && WallRemover(complex).run()) {
    context.throwIfCancelled();
    findBlocks(complex);
    findArcsAndPatches(complex);
  }
  requireBoxes(complex);
  return complex;
}

}  // namespace hexhex
