#include <algorithm>
#include <atomic>
#include <cmath>

#include <base/vector3.hpp>
#include <map/key_table.hpp>
#include <map/singularities.hpp>
#include <map/vertex_star.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kTetGrain = 4096;
/// Most vertices are plain, and a special one takes long.
constexpr std::size_t kVertexGrain = 128;

/// Sum of angles in [0, pi], without trigonometry: a complex number of the sum's argument modulo
/// pi, kept in the upper half plane, and the number of half turns.
class AngleSum {
 public:
  /// Adds the angle whose cosine and sine are proportional to the arguments; sine >= 0.
  void add(double cosine, double sine) noexcept {
    double real = real_ * cosine - imaginary_ * sine;
    double imaginary = real_ * sine + imaginary_ * cosine;
    if (imaginary < 0 || (imaginary == 0 && real < 0)) {
      real = -real;
      imaginary = -imaginary;
      ++halfTurns_;
    }
    const double norm = std::abs(real) + imaginary;
    if (!(norm > 0)) return;  // a degenerate tet: reported elsewhere
    real_ = real / norm;
    imaginary_ = imaginary / norm;
  }
  /// The sum in right angles, rounded.
  [[nodiscard]] int rightAngles() const noexcept {
    const int rest = imaginary_ < real_ ? 0 : (imaginary_ < -real_ ? 2 : 1);
    return 2 * halfTurns_ + rest;
  }

 private:
  double real_ = 1;
  double imaginary_ = 0;
  int halfTurns_ = 0;
};

/// The caller's offsets, sorted for look-up.
std::vector<EdgeValence> sorted(std::span<const EdgeValence> known) {
  std::vector<EdgeValence> list(known.begin(), known.end());
  for (EdgeValence& edge : list) {
    if (edge.vertex0 > edge.vertex1) std::swap(edge.vertex0, edge.vertex1);
  }
  std::sort(list.begin(), list.end(), [](const EdgeValence& a, const EdgeValence& b) {
    return a.vertex0 != b.vertex0 ? a.vertex0 < b.vertex0 : a.vertex1 < b.vertex1;
  });
  return list;
}

int knownOffset(const std::vector<EdgeValence>& known, Index v, Index w) {
  const auto found = std::lower_bound(known.begin(), known.end(), EdgeValence{v, w, 0},
                                      [](const EdgeValence& a, const EdgeValence& b) {
                                        return a.vertex0 != b.vertex0 ? a.vertex0 < b.vertex0
                                                                      : a.vertex1 < b.vertex1;
                                      });
  return found != known.end() && found->vertex0 == v && found->vertex1 == w ? found->offset : 0;
}

/// What is shared by all vertices.
struct Surroundings {
  const TetTopology& topology;
  const LocalParameters& parameters;
  const Array<std::uint8_t>& special;
  const std::vector<EdgeValence>& known;
  bool valencesKnown;
};

/// The edges of one special vertex after the other, with the tets around each.
class VertexEdges {
 public:
  explicit VertexEdges(const Surroundings& in) : in_(in) {}

  /// Appends singular edges to larger vertices. False if the vertex, or an edge, is not that of a
  /// manifold; `tets` grows by the number of tets seen.
  bool run(Index vertex, std::vector<SingularEdge>& singular, std::uint64_t& tets) {
    star_.collect(in_.topology, vertex);
    collectEdges(vertex);
    tets += star_.members().size();
    appendSingular(vertex, singular);
    return isManifold();
  }

 private:
  struct Edge {
    Index other;
    Index tet;  ///< the smallest
    std::uint8_t corner0;
    std::uint8_t corner1;
    std::uint8_t boundaryFaces;  ///< saturated at 3: two in a manifold
    bool wanted;                 ///< its valence matters, and is found here
    AngleSum angles;
  };

  void collectEdges(Index vertex) {
    others_.clear();
    edges_.clear();
    boundaryFaces_ = 0;
    for (const VertexStar::Member& member : star_.members()) {
      for (int corner = 0; corner < 4; ++corner) {
        if (corner == localOf(member.corner)) continue;
        addTet(edgeTo(vertex, member, corner), member, corner);
      }
    }
  }

  Edge& edgeTo(Index vertex, const VertexStar::Member& member, int corner) {
    const Index tet = tetOf(member.corner);
    const Index other = in_.topology.tets[tet][static_cast<std::size_t>(corner)];
    const Index number = others_.insert(other);
    const auto corner0 = static_cast<std::uint8_t>(localOf(member.corner));
    const auto corner1 = static_cast<std::uint8_t>(corner);
    if (number == edges_.size()) {
      // Edges at a plain vertex are regular.
      const bool wanted = other > vertex && in_.special[other] != 0;
      edges_.push_back({other, tet, corner0, corner1, 0, wanted, {}});
    }
    Edge& edge = edges_[number];
    if (tet < edge.tet) {
      edge.tet = tet;
      edge.corner0 = corner0;
      edge.corner1 = corner1;
    }
    return edge;
  }

  /// Adds a tet to an edge: its boundary faces, and its angle.
  void addTet(Edge& edge, const VertexStar::Member& member, int corner) {
    const int local = localOf(member.corner);
    for (int face = 0; face < 4; ++face) {
      if (face == local || face == corner) continue;
      if (member.neighbour[static_cast<std::size_t>(face)] != kNone) continue;
      if (edge.boundaryFaces < 3) ++edge.boundaryFaces;
      ++boundaryFaces_;
    }
    if (edge.wanted && !in_.valencesKnown)
      addAngle(edge.angles, tetOf(member.corner), local, corner);
  }

  /// The dihedral angle of a tet at the edge from corner0 to corner1.
  void addAngle(AngleSum& sum, Index tet, int corner0, int corner1) const {
    const int left =
        otherFaceAtEdge(static_cast<CornerMask>(cornerBit(corner0) | cornerBit(corner1)), -1);
    const int right = 6 - corner0 - corner1 - left;
    const Vec3 origin = in_.parameters(tet, corner0);
    const Vec3 edge = minus(in_.parameters(tet, corner1), origin);
    const Vec3 a = cross(edge, minus(in_.parameters(tet, left), origin));
    const Vec3 toRight = minus(in_.parameters(tet, right), origin);
    const Vec3 b = cross(edge, toRight);
    // |a x b| = |edge| |det(edge, left, right)|
    sum.add(dot(a, b), length(edge) * std::abs(dot(a, toRight)));
  }

  void appendSingular(Index vertex, std::vector<SingularEdge>& singular) const {
    const auto first = static_cast<std::ptrdiff_t>(singular.size());
    for (const Edge& edge : edges_) {
      if (!edge.wanted) continue;
      const bool boundary = edge.boundaryFaces > 0;
      const int regular = boundary ? 2 : 4;
      const int valence = in_.valencesKnown ? regular + knownOffset(in_.known, vertex, edge.other)
                                            : edge.angles.rightAngles();
      if (valence == regular) continue;
      singular.push_back(
          {vertex, edge.other, edge.tet, edge.corner0, edge.corner1, boundary, valence});
    }
    std::sort(singular.begin() + first, singular.end(),
              [](const SingularEdge& a, const SingularEdge& b) { return a.vertex1 < b.vertex1; });
  }

  /// Whether the link, which the walk has found to be connected, is a sphere or, on the boundary, a
  /// disk: its Euler characteristic tells, with edges of the same two vertices counted as one. (If
  /// they are two, the characteristic is too small.)
  [[nodiscard]] bool isManifold() const {
    for (const Edge& edge : edges_) {
      if (edge.boundaryFaces > 2) return false;
    }
    const auto triangles = static_cast<std::int64_t>(star_.members().size());
    // Each boundary face was seen from its two edges at the vertex.
    const std::int64_t boundaryFaces = boundaryFaces_ / 2;
    const std::int64_t sides = (3 * triangles + boundaryFaces) / 2;
    const auto corners = static_cast<std::int64_t>(edges_.size());
    return corners - sides + triangles == (boundaryFaces > 0 ? 1 : 2);
  }

  Surroundings in_;
  VertexStar star_;
  KeyTable others_;
  std::vector<Edge> edges_;
  std::int64_t boundaryFaces_ = 0;
};

/// Number of corners at special vertices.
std::uint64_t countSpecialCorners(const TetTopology& topology, const Array<std::uint8_t>& special,
                                  Stage& stage) {
  std::atomic<std::uint64_t> total = 0;
  parallelBlocks(stage, topology.tetCount(), kTetGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::uint64_t count = 0;
                   for (std::size_t t = begin; t < end; ++t) {
                     for (const Index v : topology.tets[t]) count += special[v];
                   }
                   total += count;
                 });
  return total;
}

/// Lists the singular edges at each of their two vertices.
void indexByVertex(Singularities& singularities, std::size_t pointCount) {
  singularities.degree.assign(pointCount, 0);
  singularities.incidences.reserve(2 * singularities.edges.size());
  for (std::size_t e = 0; e < singularities.edges.size(); ++e) {
    for (const Index v : {singularities.edges[e].vertex0, singularities.edges[e].vertex1}) {
      std::uint8_t& degree = singularities.degree[v];
      if (degree < 255) ++degree;
      singularities.incidences.push_back({v, static_cast<Index>(e)});
    }
  }
  std::sort(singularities.incidences.begin(), singularities.incidences.end(),
            [](const Singularities::Incidence& a, const Singularities::Incidence& b) {
              return a.vertex != b.vertex ? a.vertex < b.vertex : a.edge < b.edge;
            });
}

}  // namespace

std::span<const Singularities::Incidence> Singularities::at(Index vertex) const noexcept {
  if (degree[vertex] == 0) return {};
  const auto [first, last] =
      std::equal_range(incidences.begin(), incidences.end(), Incidence{vertex, 0},
                       [](const Incidence& a, const Incidence& b) { return a.vertex < b.vertex; });
  return {first, last};
}

std::optional<Singularities> computeSingularities(const TetTopology& topology,
                                                  const LocalParameters& parameters,
                                                  PlainVertices& plain,
                                                  std::span<const EdgeValence> known,
                                                  Stage& stage) {
  const std::vector<EdgeValence> knownEdges = sorted(known);
  for (const EdgeValence& edge : knownEdges) {
    for (const Index v : {edge.vertex0, edge.vertex1}) {
      if (!topology.isIsolated(v)) plain.special[v] = 1;
    }
  }
  const Surroundings in{topology, parameters, plain.special, knownEdges, !known.empty()};
  std::vector<std::vector<SingularEdge>> blocks(blockCount(topology.pointCount, kVertexGrain));
  std::atomic<bool> manifold = true;
  std::atomic<std::uint64_t> cornersSeen = 0;
  parallelBlocks(stage, topology.pointCount, kVertexGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   VertexEdges edges(in);
                   std::uint64_t seen = 0;
                   for (std::size_t v = begin; v < end; ++v) {
                     if (plain.special[v] == 0) continue;
                     if (!edges.run(static_cast<Index>(v), blocks[block], seen)) manifold = false;
                   }
                   cornersSeen += seen;
                 });
  // Walks that did not see all corners of their vertices met a star in several pieces.
  if (!manifold || cornersSeen != countSpecialCorners(topology, plain.special, stage)) return {};
  Singularities result;
  for (const std::vector<SingularEdge>& block : blocks) {
    result.edges.insert(result.edges.end(), block.begin(), block.end());
  }
  indexByVertex(result, topology.pointCount);
  return result;
}

}  // namespace hexhex
