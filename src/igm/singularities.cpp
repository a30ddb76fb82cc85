// Valences of the edges at irregular vertices (Section 5.1.2).
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <tuple>

#include <adjacency/key_table.hpp>

#include <base/low_level.hpp>
#include <base/workspaces.hpp>
#include <igm/singularities.hpp>

namespace hexhex::igm {

namespace {

constexpr std::size_t kTetGrain = 4096;

/// Sum of angles in [0, pi], without trigonometry: a complex number whose argument is the sum
/// modulo pi, kept in the upper half plane, and the number of half turns.
class AngleSum {
 public:
  /// Adds the angle whose cosine and sine are proportional to the arguments; sine >= 0.
  void add(double cosine, double sine) noexcept {
    const double real = real_ * cosine - imaginary_ * sine;
    const double imaginary = real_ * sine + imaginary_ * cosine;
    const bool isTurned = imaginary < 0 || (imaginary == 0 && real < 0);
    const double sign = isTurned ? -1 : 1;
    halfTurns_ += isTurned ? 1 : 0;
    const double norm = std::abs(real) + std::abs(imaginary);
    if (!(norm > 0)) return;  // a degenerate tet: reported elsewhere
    real_ = sign * real / norm;
    imaginary_ = sign * imaginary / norm;
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

/// The valence offsets given by the caller, for look-up.
class KnownOffsets {
 public:
  explicit KnownOffsets(std::span<const EdgeValence> known) : list_(known.begin(), known.end()) {
    for (EdgeValence& edge : list_) {
      if (edge.vertex0 > edge.vertex1) std::swap(edge.vertex0, edge.vertex1);
    }
    std::sort(list_.begin(), list_.end(), isBefore);
  }
  [[nodiscard]] bool empty() const noexcept { return list_.empty(); }

  /// @param v  smaller than w
  [[nodiscard]] int at(Index v, Index w) const {
    const EdgeValence wanted{v, w, 0};
    const auto found = std::lower_bound(list_.begin(), list_.end(), wanted, isBefore);
    return found != list_.end() && !isBefore(wanted, *found) ? found->offset : 0;
  }

 private:
  static bool isBefore(const EdgeValence& a, const EdgeValence& b) {
    return std::tie(a.vertex0, a.vertex1) < std::tie(b.vertex0, b.vertex1);
  }
  std::vector<EdgeValence> list_;
};

/// What all vertices share.
struct Surroundings {
  const adjacency::TetTopology& topology;
  const LocalParameters& parameters;
  const RegularVertices& regular;
  std::span<const HalfFaceTransition> faceTransitions;
  const VertexKinds& vertices;
  const KnownOffsets& known;
};

/// The edges of irregular vertices, one vertex after the other, with the tets around each edge.
class VertexEdges {
 public:
  explicit VertexEdges(const Surroundings& in) : in_(in) {}

  /// Appends singular edges to larger vertices. False if the vertex, or an edge, is not manifold.
  bool run(Index vertex, std::span<const VertexStar::Member> star,
           std::vector<SingularEdge>& singular) {
    star_ = star;
    collectEdges();
    appendSingular(vertex, singular);
    return isManifold();
  }

 private:
  struct Edge {
    Index other;                    ///< vertex
    std::uint32_t turns;            ///< tets in one fixed direction from the edge
    std::uint32_t nonTrivialFaces;  ///< where charts may differ; counted from each tet
    std::uint32_t boundaryFaces;    ///< two in a manifold, or none; counted likewise
  };

  /// A tet at an edge.
  struct Wedge {
    adjacency::CornerIndex corner;  ///< at the vertex
    std::size_t k;                  ///< the edge leads to corner kOthers[corner % 4][k]
  };

  /// Counts faces and edges without branches, which could not be predicted.
  void collectEdges() {
    others_.clear();
    others_.makeRoom(3 * star_.size());
    if (edges_.size() <= 3 * star_.size()) edges_.resize(2 * (3 * star_.size()));
    const adjacency::KeyTable::Numberer number = others_.numberer();
    numbers_.resize(star_.size());
    Index count = 0;
    std::int64_t boundaryFaces = 0;
    for (std::size_t i = 0; i < star_.size(); ++i) {
      const VertexStar::Member& member = star_[i];
      const Tet& tet = in_.topology.tets[member.tet()];
      const std::array<std::uint8_t, 3>& corners = kOthers[member.corner % 4];
      const TetSides sides = in_.regular.sides[member.tet()];
      std::array<Index, 3>& numbers = numbers_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        edges_[count] = {tet[corners[k]], 0, 0, 0};
        numbers[k] = number(tet[corners[k]], count);
        count += numbers[k] == count ? 1 : 0;
      }
      std::array<std::uint32_t, 3> inward{};
      std::array<std::uint32_t, 3> isNonTrivial{};
      std::array<std::uint32_t, 3> isBoundary{};
      for (std::size_t k = 0; k < 3; ++k) {
        const HalfFaceTransition across = in_.faceTransitions[4 * member.tet() + corners[k]];
        inward[k] = leadsInward(sides, corners[k]) ? 1 : 0;
        isNonTrivial[k] = across.isTrivial() ? 0 : 1;
        isBoundary[k] = member.neighbour[k] == kNone ? 1 : 0;
        boundaryFaces += isBoundary[k];
      }
      // The faces at the edge to corner k are opposite the other two corners.
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3;
        const std::size_t m = (k + 2) % 3;
        Edge& edge = edges_[numbers[k]];
        edge.turns += inward[l] & inward[m];
        edge.nonTrivialFaces += isNonTrivial[l] + isNonTrivial[m];
        edge.boundaryFaces += isBoundary[l] + isBoundary[m];
      }
    }
    edgeCount_ = count;
    boundaryFaces_ = boundaryFaces;
  }

  void addAngle(const Wedge& wedge, AngleSum& sum) const {
    const auto [corner, k] = wedge;
    const std::array<std::uint8_t, 3>& others = kOthers[corner % 4];
    TetParameters scratch;
    const TetParameters& u = in_.parameters.see(adjacency::tetOf(corner), scratch);
    const Vec3 edge = minus(u[others[k]], u[corner % 4]);
    const Vec3 a = minus(u[others[(k + 1) % 3]], u[corner % 4]);
    const Vec3 b = minus(u[others[(k + 2) % 3]], u[corner % 4]);
    const Vec3 normalA = cross(edge, a);
    const Vec3 normalB = cross(edge, b);
    // |normalA x normalB| = |edge| |det(edge, a, b)|.
    sum.add(dot(normalA, normalB), length(edge) * std::abs(dot(normalA, b)));
  }

  /// Lists the tets around an edge, without branches: which ones they are cannot be predicted.
  [[nodiscard]] std::span<const Wedge> wedgesAt(Index e) {
    wedges_.resize(star_.size() + 1);
    std::size_t count = 0;
    for (std::size_t i = 0; i < star_.size(); ++i) {
      const std::array<Index, 3>& edges = numbers_[i];
      const std::size_t k = (edges[1] == e ? 1U : 0U) + (edges[2] == e ? 2U : 0U);
      wedges_[count] = {star_[i].corner, k};
      count += edges[k] == e ? 1 : 0;
    }
    return std::span(wedges_).first(count);
  }

  /// The sum of angles around an edge, in right angles.
  [[nodiscard]] int sumOfAngles(Index e) {
    AngleSum sum;
    for (const Wedge& wedge : wedgesAt(e)) addAngle(wedge, sum);
    return sum.rightAngles();
  }

  /// The number of hexahedra around an edge. If all tets around it lie in one chart, and are known
  /// to be positive, they turn around it as many times as they cover any direction.
  [[nodiscard]] int valenceOf(Index vertex, Index e) {
    const Edge& edge = edges_[e];
    if (!in_.known.empty()) return regularValence(edge) + in_.known.at(vertex, edge.other);
    return edge.nonTrivialFaces > 0 ? sumOfAngles(e) : 4 * static_cast<int>(edge.turns);
  }

  static int regularValence(const Edge& edge) { return edge.boundaryFaces > 0 ? 2 : 4; }

  void appendSingular(Index vertex, std::vector<SingularEdge>& singular) {
    const auto first = static_cast<std::ptrdiff_t>(singular.size());
    // Edges at a regular vertex are regular; the others are listed at their smaller vertex, without
    // branches, which could not be predicted.
    candidates_.resize(edgeCount_ + 1);
    std::size_t count = 0;
    for (Index e = 0; e < edgeCount_; ++e) {
      const Index other = edges_[e].other;
      candidates_[count] = e;
      count += allOf(other > vertex, in_.vertices.kind[other] == VertexKind::Irregular) ? 1 : 0;
    }
    for (const Index e : std::span(candidates_).first(count)) {
      const int valence = valenceOf(vertex, e);
      if (valence != regularValence(edges_[e])) singular.push_back(located(vertex, e, valence));
    }
    std::sort(singular.begin() + first, singular.end(),
              [](const SingularEdge& a, const SingularEdge& b) { return a.vertex1 < b.vertex1; });
  }

  /// A singular edge, in its smallest tet.
  [[nodiscard]] SingularEdge located(Index vertex, Index number, int valence) {
    const std::span<const Wedge> wedges = wedgesAt(number);
    const Wedge& first =
        *std::min_element(wedges.begin(), wedges.end(),
                          [](const Wedge& a, const Wedge& b) { return a.corner < b.corner; });
    const Edge& edge = edges_[number];
    return {vertex,
            edge.other,
            adjacency::tetOf(first.corner),
            static_cast<std::uint8_t>(first.corner % 4),
            kOthers[first.corner % 4][first.k],
            edge.boundaryFaces > 0,
            valence};
  }

  /// Whether the link, which the walk has found to be connected, is a sphere or, on the boundary, a
  /// disk: its Euler characteristic tells, with edges between the same two vertices counted as one.
  /// (If there are two, the characteristic is too small.)
  [[nodiscard]] bool isManifold() const {
    for (Index e = 0; e < edgeCount_; ++e) {
      if (edges_[e].boundaryFaces > 2) return false;
    }
    const auto triangles = static_cast<std::int64_t>(star_.size());
    const std::int64_t sides = (3 * triangles + boundaryFaces_) / 2;
    const auto corners = static_cast<std::int64_t>(edgeCount_);
    return corners - sides + triangles == (boundaryFaces_ > 0 ? 1 : 2);
  }

  Surroundings in_;
  std::span<const VertexStar::Member> star_;
  adjacency::KeyTable others_;  ///< numbers the edges by their other vertices
  std::vector<Edge> edges_;     ///< more than are in use
  Index edgeCount_ = 0;
  std::vector<Index> candidates_;              ///< for being singular; more than are in use
  std::vector<Wedge> wedges_;                  ///< more than are in use
  std::vector<std::array<Index, 3>> numbers_;  ///< per member of the star: the numbers of its edges
  std::int64_t boundaryFaces_ = 0;             ///< at the vertex
};

/// Number of corners at vertices that are not certainly regular.
std::uint64_t countCorners(const adjacency::TetTopology& topology, const VertexKinds& vertices,
                           Stage& stage) {
  std::atomic<std::uint64_t> total = 0;
  parallelBlocks(stage, topology.tetCount(), kTetGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::uint64_t count = 0;
                   for (std::size_t t = begin; t < end; ++t) {
                     for (const Index v : topology.tets[t]) {
                       count += vertices.kind[v] != VertexKind::Regular ? 1 : 0;
                     }
                   }
                   total += count;
                 });
  return total;
}

/// Lists each singular edge at both its vertices.
void indexByVertex(Singularities& singularities, std::size_t pointCount) {
  Array<Index>& begin = singularities.begin;
  begin.assign(pointCount + 1, 0);
  const std::vector<SingularEdge>& edges = singularities.edges;
  for (const SingularEdge& edge : edges) {
    ++begin[edge.vertex0];
    ++begin[edge.vertex1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  // Backwards, so that the end of each vertex's list moves to its beginning.
  singularities.incident.resize(2 * edges.size());
  for (std::size_t e = edges.size(); e > 0;) {
    --e;
    singularities.incident[--begin[edges[e].vertex0]] = static_cast<Index>(e);
    singularities.incident[--begin[edges[e].vertex1]] = static_cast<Index>(e);
  }
}

}  // namespace

std::optional<Singularities> computeSingularities(
    const adjacency::TetTopology& topology, const LocalParameters& parameters,
    const RegularVertices& regular, std::span<const HalfFaceTransition> faceTransitions,
    const VertexKinds& vertices, std::span<const EdgeValence> known, Stage& stage) {
  const KnownOffsets offsets(known);
  const Surroundings in{topology, parameters, regular, faceTransitions, vertices, offsets};
  std::vector<std::vector<SingularEdge>> singular(vertices.blocks.size());
  std::atomic<bool> isManifold = true;
  parallelForWith(
      stage, vertices.blocks.size(), 1, [&] { return VertexEdges(in); },
      [&](std::size_t b, VertexEdges& edges) {
        const StarBlock& block = vertices.blocks[b];
        for (std::size_t i = 0; i < block.vertices.size(); ++i) {
          if (!edges.run(block.vertices[i], block.star(i), singular[b])) isManifold = false;
        }
      });
  std::uint64_t cornersSeen = 0;
  for (const StarBlock& block : vertices.blocks) cornersSeen += block.cornersSeen;
  // If walks missed corners of their vertices, some star is in several pieces.
  if (!isManifold || cornersSeen != countCorners(topology, vertices, stage)) return {};
  Singularities result;
  result.edges = joined<SingularEdge>(singular);
  indexByVertex(result, topology.pointCount);
  return result;
}

}  // namespace hexhex::igm
