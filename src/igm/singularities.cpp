#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include <adjacency/key_table.hpp>

#include <base/branchless.hpp>
#include <base/vector3.hpp>
#include <base/workspaces.hpp>
#include <igm/flat_stars.hpp>
#include <igm/singularities.hpp>

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
    const double real = real_ * cosine - imaginary_ * sine;
    const double imaginary = real_ * sine + imaginary_ * cosine;
    const bool isTurned = anyOf(imaginary < 0, allOf(imaginary == 0, real < 0));
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
  const PlainVertices& plain;
  const std::vector<EdgeValence>& known;
  bool valencesKnown;
};

/// The edges of one special vertex after the other, with the tets around each.
class VertexEdges {
 public:
  explicit VertexEdges(const Surroundings& in) : in_(in) {}

  /// Appends singular edges to larger vertices. False if the vertex, or an edge, is not that of a
  /// manifold.
  bool run(Index vertex, std::span<const VertexStar::Member> star,
           std::vector<SingularEdge>& singular) {
    star_ = star;
    collectEdges(vertex);
    if (anglesNeeded_) addAngles();
    appendSingular(vertex, singular);
    return isManifold();
  }

 private:
  struct Edge {
    Index other;
    std::uint32_t turns;  ///< tets in one and the same direction from the edge
    std::uint64_t faces;  ///< sum of what they are, seen from each tet

    [[nodiscard]] bool onBoundary() const { return boundaryFaces() > 0; }
    /// Two in a manifold.
    [[nodiscard]] std::uint64_t boundaryFaces() const { return faces / kBoundaryFace; }
    /// Whether charts may differ across a face.
    [[nodiscard]] bool mayTurn() const { return faces > 0; }
  };
  static constexpr std::uint64_t kCutFace = 1;
  static constexpr std::uint64_t kBoundaryFace = std::uint64_t{1} << 32;

  /// Of one edge: the sum of dihedral angles, if its valence is wanted and turns do not tell it.
  struct Angles {
    bool wanted = false;
    bool needed = false;
    AngleSum sum;
  };

  /// A tet at an edge.
  struct Wedge {
    Index member;
    std::uint8_t edge;  ///< in the order of kOthers
  };

  /// One tet's edges at the vertex: their numbers in `edges_`, in the order of kOthers.
  using EdgeNumbers = std::array<Index, 3>;

  /// Without branches, as these could not be foretold.
  void collectEdges(Index vertex) {
    others_.clear();
    if (edges_.size() <= 3 * star_.size()) edges_.resize(2 * (3 * star_.size()));
    Index count = 0;
    numbers_.resize(star_.size());
    faces_ = 0;
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      const VertexStar::Member& member = star_[i];
      const Tet& tet = in_.topology.tets[member.tet()];
      const std::array<std::uint8_t, 3>& corners = kOthers[member.corner % 4];
      const Passage* const passages = &in_.plain.passages[4 * std::size_t{member.tet()}];
      const TetSides sides = in_.plain.sides[member.tet()];
      std::array<std::uint64_t, 3> faces{};
      std::array<std::uint32_t, 3> inward{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Index other = tet[corners[k]];
        edges_[count] = Edge{other, 0, 0};
        numbers_[i][k] = others_.insert(other);
        count += numbers_[i][k] == count ? 1 : 0;
        inward[k] = leadsInward(sides, corners[k]);
        faces[k] = (passages[corners[k]].isPlain() ? 0 : kCutFace) +
                   (member.neighbour[k] == kNone ? kBoundaryFace : 0);
      }
      faces_ += faces[0] + faces[1] + faces[2];
      // The faces at the edge to corner k are those opposite the two other corners.
      for (std::size_t k = 0; k < 3; ++k) {
        Edge& edge = edges_[numbers_[i][k]];
        const std::size_t l = (k + 1) % 3;
        const std::size_t m = (k + 2) % 3;
        edge.turns += inward[l] & inward[m];
        edge.faces += faces[l] + faces[m];
      }
    }
    edgeCount_ = count;
    selectEdges(vertex);
  }

  void selectEdges(Index vertex) {
    anglesNeeded_ = false;
    angles_.assign(edgeCount_, Angles{});
    for (std::size_t e = 0; e < angles_.size(); ++e) {
      // Edges at a plain vertex are regular.
      angles_[e].wanted = allOf(edges_[e].other > vertex, in_.plain.special[edges_[e].other] == 1);
      angles_[e].needed = allOf(angles_[e].wanted, !in_.valencesKnown, edges_[e].mayTurn());
      anglesNeeded_ = anyOf(anglesNeeded_, angles_[e].needed);
    }
  }

  [[nodiscard]] std::span<const Edge> edges() const { return {edges_.data(), edgeCount_}; }

  /// Adds up dihedral angles where turns do not tell the valence.
  void addAngles() {
    if (wedges_.size() <= 3 * numbers_.size()) wedges_.resize(2 * (3 * numbers_.size()));
    std::size_t count = 0;
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      for (std::uint8_t k = 0; k < 3; ++k) {
        wedges_[count] = {static_cast<Index>(i), k};
        count += angles_[numbers_[i][k]].needed ? 1 : 0;
      }
    }
    for (const Wedge& wedge : std::span(wedges_).first(count)) addAngle(wedge);
  }

  void addAngle(const Wedge& wedge) {
    const CornerIndex corner = star_[wedge.member].corner;
    const std::array<std::uint8_t, 3>& others = kOthers[corner % 4];
    TetParameters scratch;
    const TetParameters& u = in_.parameters.see(tetOf(corner), scratch);
    const Vec3 edge = minus(u[others[wedge.edge]], u[corner % 4]);
    const Vec3 a = minus(u[others[(wedge.edge + 1U) % 3]], u[corner % 4]);
    const Vec3 b = minus(u[others[(wedge.edge + 2U) % 3]], u[corner % 4]);
    const Vec3 normalA = cross(edge, a);
    const Vec3 normalB = cross(edge, b);
    // |normalA x normalB| = |edge| |det(edge, a, b)|.
    angles_[numbers_[wedge.member][wedge.edge]].sum.add(dot(normalA, normalB),
                                                        length(edge) * std::abs(dot(normalA, b)));
  }

  /// The number of hexahedra around an edge. If all tets around it lie in one chart, and are known
  /// to be positive, they turn around it as often as they meet any direction.
  [[nodiscard]] int valenceOf(Index vertex, std::size_t e) const {
    const Edge& edge = edges_[e];
    if (in_.valencesKnown) {
      return (edge.onBoundary() ? 2 : 4) + knownOffset(in_.known, vertex, edge.other);
    }
    return angles_[e].needed ? angles_[e].sum.rightAngles() : 4 * static_cast<int>(edge.turns);
  }

  void appendSingular(Index vertex, std::vector<SingularEdge>& singular) const {
    const auto first = static_cast<std::ptrdiff_t>(singular.size());
    for (std::size_t e = 0; e < edges().size(); ++e) {
      if (!angles_[e].wanted) continue;
      const int valence = valenceOf(vertex, e);
      const bool boundary = edges_[e].onBoundary();
      if (valence == (boundary ? 2 : 4)) continue;
      singular.push_back(located(vertex, static_cast<Index>(e), boundary, valence));
    }
    std::sort(singular.begin() + first, singular.end(),
              [](const SingularEdge& a, const SingularEdge& b) { return a.vertex1 < b.vertex1; });
  }

  /// A singular edge, in the smallest tet at it.
  [[nodiscard]] SingularEdge located(Index vertex, Index number, bool boundary, int valence) const {
    // Corners by tet, and which of the others it is in the lowest bits: the smallest one counts.
    std::uint64_t smallest = ~std::uint64_t{0};
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      for (std::uint64_t k = 0; k < 3; ++k) {
        const std::uint64_t isOther = numbers_[i][k] == number ? 0 : 1;
        smallest = std::min(smallest, (4 * std::uint64_t{star_[i].corner} + k) | (0 - isOther));
      }
    }
    const std::size_t corner = smallest / 4 % 4;
    return {vertex,
            edges_[number].other,
            static_cast<Index>(smallest / 16),
            static_cast<std::uint8_t>(corner),
            kOthers[corner][smallest % 4],
            boundary,
            valence};
  }

  /// Whether the link, which the walk has found to be connected, is a sphere or, on the boundary, a
  /// disk: its Euler characteristic tells, with edges of the same two vertices counted as one. (If
  /// they are two, the characteristic is too small.)
  [[nodiscard]] bool isManifold() const {
    for (const Edge& edge : edges()) {
      if (edge.boundaryFaces() > 2) return false;
    }
    const auto triangles = static_cast<std::int64_t>(star_.size());
    const auto boundaryFaces = static_cast<std::int64_t>(faces_ / kBoundaryFace);
    const std::int64_t sides = (3 * triangles + boundaryFaces) / 2;
    const auto corners = static_cast<std::int64_t>(edgeCount_);
    return corners - sides + triangles == (boundaryFaces > 0 ? 1 : 2);
  }

  Surroundings in_;
  std::span<const VertexStar::Member> star_;
  KeyTable<> others_;  ///< numbers the edges by their other vertices
  Array<Edge> edges_;  ///< more than are in use
  std::size_t edgeCount_ = 0;
  std::vector<Angles> angles_;  ///< per edge
  Array<EdgeNumbers> numbers_;  ///< per member of the star
  Array<Wedge> wedges_;         ///< more than are in use
  std::uint64_t faces_ = 0;     ///< of the vertex, as those of edges
  bool anglesNeeded_ = false;
};

/// Finds the stars of special vertices, and keeps those that are not flat.
class StarSorter {
 public:
  /// @param flatAllowed  otherwise no star is called flat
  StarSorter(const TetTopology& topology, const LocalParameters& parameters, PlainVertices& plain,
             bool flatAllowed)
      : plain_(plain), flat_(topology, parameters, plain), flatAllowed_(flatAllowed) {}

  /// @param stars  receives the star
  void run(Index vertex, StarBlock& stars) {
    const bool isFlat = flat_.run(vertex, star_) && flatAllowed_;
    const std::span<const VertexStar::Member> star = star_.members();
    stars.cornersSeen += star.size();
    if (!isFlat) {
      stars.add(vertex, star, flat_.planes());
      plain_.plane[vertex] = PlainVertices::kDecidedByStar;
      return;
    }
    plain_.special[vertex] = PlainVertices::kFlat;
    plain_.plane[vertex] = flat_.onBoundary() ? PlainVertices::kPlaneOfStar : 0;
    if (!flat_.onBoundary()) return;
    for (const VertexStar::Member& member : star) {
      stars.planeCorners.push_back({member.corner, 1U << flat_.axis(member)});
    }
  }

 private:
  PlainVertices& plain_;
  VertexStar star_;
  FlatStarTest flat_;
  bool flatAllowed_;
};

/// Number of corners at special vertices, with flat stars or not.
std::uint64_t countSpecialCorners(const TetTopology& topology, const Array<std::uint8_t>& special,
                                  Stage& stage) {
  std::atomic<std::uint64_t> total = 0;
  parallelBlocks(stage, topology.tetCount(), kTetGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::uint64_t count = 0;
                   for (std::size_t t = begin; t < end; ++t) {
                     for (const Index v : topology.tets[t]) count += special[v] != 0 ? 1 : 0;
                   }
                   total += count;
                 });
  return total;
}

/// Lists the singular edges at each of their two vertices.
void indexByVertex(Singularities& singularities, std::size_t pointCount) {
  Array<Index>& begin = singularities.begin;
  begin.assign(pointCount + 1, 0);
  const std::vector<SingularEdge>& edges = singularities.edges;
  for (const SingularEdge& edge : edges) {
    ++begin[edge.vertex0];
    ++begin[edge.vertex1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  // Backwards, so that where each vertex's edges end becomes where they begin.
  singularities.incident.resize(2 * edges.size());
  for (std::size_t e = edges.size(); e-- > 0;) {
    singularities.incident[--begin[edges[e].vertex0]] = static_cast<Index>(e);
    singularities.incident[--begin[edges[e].vertex1]] = static_cast<Index>(e);
  }
}

}  // namespace

void collectStars(const TetTopology& topology, const LocalParameters& parameters,
                  PlainVertices& plain, std::span<const EdgeValence> known,
                  const Transitions* transitions, std::vector<StarBlock>& stars, Stage& stage) {
  for (const EdgeValence& edge : known) {
    for (const Index v : {edge.vertex0, edge.vertex1}) {
      if (!topology.isIsolated(v)) plain.special[v] = 1;
    }
  }
  // What the caller claims about edges, if anything, is to be looked up for each.
  const bool flatAllowed = known.empty() && transitions != nullptr;
  stars.resize(blockCount(topology.pointCount, kVertexGrain));
  const auto makeSorter = [&] { return StarSorter(topology, parameters, plain, flatAllowed); };
  parallelBlocksWith(
      stage, topology.pointCount, kVertexGrain, makeSorter,
      [&](std::size_t begin, std::size_t end, std::size_t block, StarSorter& sorter) {
        const auto specials = static_cast<std::size_t>(
            std::count_if(&plain.special[begin], &plain.special[begin] + (end - begin),
                          [](std::uint8_t special) { return special != 0; }));
        if (specials == 0) return;
        stars[block].reserve(specials);
        for (std::size_t v = begin; v < end; ++v) {
          if (plain.special[v] != 0) sorter.run(static_cast<Index>(v), stars[block]);
        }
      });
}

std::optional<Singularities> computeSingularities(const TetTopology& topology,
                                                  const LocalParameters& parameters,
                                                  const PlainVertices& plain,
                                                  std::span<const EdgeValence> known,
                                                  std::span<const StarBlock> stars, Stage& stage) {
  const std::vector<EdgeValence> knownEdges = sorted(known);
  const Surroundings in{topology, parameters, plain, knownEdges, !known.empty()};
  std::vector<std::vector<SingularEdge>> blocks(stars.size());
  std::atomic<bool> manifold = true;
  const auto runBlock = [&](std::size_t block, VertexEdges& edges) {
    for (std::size_t i = 0; i < stars[block].vertices.size(); ++i) {
      if (!edges.run(stars[block].vertices[i], stars[block].star(i), blocks[block])) {
        manifold = false;
      }
    }
  };
  parallelForWith(
      stage, stars.size(), 1, [&] { return VertexEdges(in); }, runBlock);
  std::uint64_t cornersSeen = 0;
  for (const StarBlock& block : stars) cornersSeen += block.cornersSeen;
  // Walks that did not see all corners of their vertices met a star in several pieces.
  if (!manifold || cornersSeen != countSpecialCorners(topology, plain.special, stage)) return {};
  Singularities result;
  result.edges = joined<SingularEdge>(blocks);
  indexByVertex(result, topology.pointCount);
  return result;
}

}  // namespace hexhex
