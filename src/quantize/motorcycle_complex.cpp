#include <algorithm>
#include <set>
#include <string>

#include <quantize/motorcycle_complex.hpp>

#include <base/disjoint_sets.hpp>

namespace hexhex {

namespace {

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
void findPatches(MotorcycleComplex& complex, const ArcFinder& arcs, DisjointSets& sides) {
  const WallMesh& mesh = complex.mesh;
  complex.patchOf.assign(mesh.mate.size(), kNone);
  std::vector<std::set<ArcSide>> borders;
  for (HalfFace h = 0; h < mesh.mate.size(); ++h) {
    if (!mesh.isWall[h]) continue;
    const HalfFace first = sides.find(h);
    if (first == h) {
      complex.patchOf[h] = static_cast<Index>(complex.patches.size());
      complex.patches.push_back({complex.blockOf[tetOf(h)], h, {}});
      borders.emplace_back();
    }
    complex.patchOf[h] = complex.patchOf[first];
    const Index tet = tetOf(h);
    const auto& c = kFaceCorners[h % 4];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto tail = static_cast<std::size_t>(c[k]);
      const auto head = static_cast<std::size_t>(c[(k + 1) % 3]);
      const auto at = arcs.positionOf(mesh.tets[tet][tail], mesh.tets[tet][head]);
      if (at.arc == kNone) continue;
      const LatticePoint from = complex.toBlock[tet](mesh.at(tet, tail));
      const LatticePoint along = complex.toBlock[tet](mesh.at(tet, head)) - from;
      ArcSide side;
      side.arc = at.arc;
      while (along[side.axis] == 0) ++side.axis;
      side.sign = along[side.axis] > 0 ? 1 : -1;
      // The arc's node from which the side comes lies this far behind.
      const std::int64_t length = complex.arcs[at.arc].length;
      const std::int64_t behind = at.isForward ? at.offset : length - at.offset;
      side.start = side.end = from;
      side.start[side.axis] -= side.sign * behind;
      side.end[side.axis] += side.sign * (length - behind);
      borders[complex.patchOf[h]].insert(side);
      for (const std::size_t corner : {tail, head}) {
        const Index vertex = mesh.tets[tet][corner];
        const bool isNode = arcs.isNode(vertex) && mesh.featureVertices.contains(vertex);
        if (!isNode && !complex.arcs[at.arc].isFeature) continue;
        const LatticePoint here = complex.toBlock[tet](mesh.at(tet, corner));
        complex.featureCorners.push_back(
            {tet, corner, isNode ? 3 : std::size_t{side.axis}, isNode ? here : side.start});
      }
    }
  }
  for (std::size_t p = 0; p < borders.size(); ++p) {
    complex.patches[p].border.assign(borders[p].begin(), borders[p].end());
  }
}

void findArcsAndPatches(MotorcycleComplex& complex) {
  complex.arcs.clear();
  complex.patches.clear();
  complex.featureCorners.clear();
  DisjointSets sides(complex.mesh.mate.size());
  ArcFinder arcs(complex, sides);
  arcs.collect();
  arcs.follow();
  findPatches(complex, arcs, sides);
}

/// From the lowest corner to the highest one of what a patch's border encloses.
LatticePoint sizeOf(const PatchSide& patch) {
  LatticePoint low = patch.border.front().start;
  LatticePoint high = low;
  for (const ArcSide& side : patch.border) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], side.start[k]);
      high[k] = std::max(high[k], side.start[k]);
    }
  }
  return high - low;
}

/// Takes away walls between two blocks that are one box without it: arcs that nothing needs would
/// only demand hexahedra (the reduced complex of Brueckner et al.). Thin blocks go first.
/// @return whether there were any
bool removeWalls(MotorcycleComplex& complex) {
  std::vector<LatticePoint> low(complex.blockCount);
  std::vector<LatticePoint> high(complex.blockCount);
  std::vector<bool> isKnown(complex.blockCount);
  for (const PatchSide& patch : complex.patches) {
    for (const ArcSide& side : patch.border) {
      const Index b = patch.block;
      if (!isKnown[b]) low[b] = high[b] = side.start;
      isKnown[b] = true;
      for (std::size_t k = 0; k < 3; ++k) {
        low[b][k] = std::min(low[b][k], side.start[k]);
        high[b][k] = std::max(high[b][k], side.start[k]);
      }
    }
  }
  // A patch that is a whole side of a block: then how thick the block is there, otherwise nothing.
  const auto thickness = [&](const PatchSide& patch) -> std::int64_t {
    const LatticePoint size = sizeOf(patch);
    const LatticePoint whole = high[patch.block] - low[patch.block];
    std::int64_t thick = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (size[k] == 0) {
        thick = whole[k];
      } else if (size[k] != whole[k]) {
        return 0;
      }
    }
    return thick;
  };
  std::vector<bool> isFeature(complex.patches.size());
  for (HalfFace h = 0; h < complex.patchOf.size(); ++h) {
    if (complex.mesh.isFeature[h]) isFeature[complex.patchOf[h]] = true;
  }
  for (Index p = 0; p < complex.patches.size(); ++p) {
    for (const ArcSide& side : complex.patches[p].border) {
      if (complex.arcs[side.arc].isFeature) isFeature[p] = true;
    }
  }
  std::vector<std::pair<std::int64_t, Index>> removable;
  for (Index p = 0; p < complex.patches.size(); ++p) {
    const Index other = complex.acrossPatch(p);
    if (other == kNone || other < p) continue;
    const PatchSide& here = complex.patches[p];
    const PatchSide& there = complex.patches[other];
    if (here.block == there.block || isFeature[p]) continue;
    const std::int64_t a = thickness(here);
    const std::int64_t b = thickness(there);
    if (a != 0 && b != 0) removable.emplace_back(std::min(a, b), p);
  }
  std::sort(removable.begin(), removable.end());
  std::vector<bool> isChanged(complex.blockCount);
  std::vector<bool> isRemoved(complex.patches.size());
  for (const auto& [thick, p] : removable) {
    const Index other = complex.acrossPatch(p);
    const Index a = complex.patches[p].block;
    const Index b = complex.patches[other].block;
    if (isChanged[a] || isChanged[b]) continue;
    isChanged[a] = isChanged[b] = true;
    isRemoved[p] = isRemoved[other] = true;
  }
  for (HalfFace h = 0; h < complex.patchOf.size(); ++h) {
    if (complex.patchOf[h] != kNone && isRemoved[complex.patchOf[h]])
      complex.mesh.isWall[h] = false;
  }
  return !removable.empty();
}

/// A block is a box if it has the volume of its bounding box.
void requireBoxes(const MotorcycleComplex& complex) {
  struct Extent {
    LatticePoint low{}, high{};
    Int192 sixfoldVolume;
    Index tet = kNone;
  };
  std::vector<Extent> extents(complex.blockCount);
  for (Index t = 0; t < complex.mesh.tetCount(); ++t) {
    Extent& extent = extents[complex.blockOf[t]];
    LatticeTet u = complex.mesh.corners[t];
    for (LatticePoint& corner : u) corner = complex.toBlock[t](corner);
    if (extent.tet == kNone) extent = {u[0], u[0], {}, t};
    for (const LatticePoint& corner : u) {
      for (std::size_t k = 0; k < 3; ++k) {
        extent.low[k] = std::min(extent.low[k], corner[k]);
        extent.high[k] = std::max(extent.high[k], corner[k]);
      }
    }
    const Int192 volume = orientationDeterminant(u[0], u[1], u[2], u[3]);
    if (volume.sign() <= 0) {
      throw Error(ErrorCode::FlippedTet, "A tet is too thin in the map to be cut by a wall.",
                  {PlaceKind::Tet, complex.mesh.original[t]});
    }
    extent.sixfoldVolume += volume;
  }
  for (const Extent& extent : extents) {
    const LatticePoint size = extent.high - extent.low;
    Int192 box;
    box.addProduct(static_cast<Int128>(size[0]) * size[1], -6 * size[2]);
    box += extent.sixfoldVolume;
    if (box.sign() != 0) {
      throw Error(ErrorCode::Internal,
                  "A block of the motorcycle complex is no box. This is a bug.",
                  {PlaceKind::Tet, complex.mesh.original[extent.tet]});
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
  while (reduced && removeWalls(complex)) {
    context.throwIfCancelled();
    findBlocks(complex);
    findArcsAndPatches(complex);
  }
  requireBoxes(complex);
  return complex;
}

}  // namespace hexhex
