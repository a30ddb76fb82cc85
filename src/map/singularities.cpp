#include <algorithm>
#include <cmath>

#include <base/vector3.hpp>
#include <map/singularities.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// Sum of angles in [0, pi], without trigonometry: a complex number of the sum's argument modulo
/// pi, kept in the upper half plane, and the number of half turns.
class AngleSum {
 public:
  /// Adds the angle whose cosine and sine are proportional to the arguments; sine >= 0.
  void add(double cosine, double sine) noexcept {
    const double size = std::abs(cosine) + sine;
    if (size == 0) return;  // a degenerate tet: reported elsewhere
    cosine /= size;
    sine /= size;
    double real = real_ * cosine - imaginary_ * sine;
    double imaginary = real_ * sine + imaginary_ * cosine;
    if (imaginary < 0 || (imaginary == 0 && real < 0)) {
      real = -real;
      imaginary = -imaginary;
      ++halfTurns_;
    }
    const double norm = std::abs(real) + imaginary;
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

/// Number of hexahedra around an edge: the sum of dihedral angles in right angles.
int valence(const LocalParameters& parameters, std::span<const EdgeCorner> fan) {
  AngleSum sum;
  for (const EdgeCorner& at : fan) {
    const int left =
        otherFaceAtEdge(static_cast<CornerMask>(cornerBit(at.corner0) | cornerBit(at.corner1)), -1);
    const int right = 6 - at.corner0 - at.corner1 - left;
    const Vec3 origin = parameters(at.tet, at.corner0);
    const Vec3 edge = minus(parameters(at.tet, at.corner1), origin);
    const Vec3 a = cross(edge, minus(parameters(at.tet, left), origin));
    const Vec3 toRight = minus(parameters(at.tet, right), origin);
    const Vec3 b = cross(edge, toRight);
    // |a x b| = |edge| |det(edge, left, right)|
    sum.add(dot(a, b), length(edge) * std::abs(dot(a, toRight)));
  }
  return sum.rightAngles();
}

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

Singularities computeSingularities(const TetTopology& topology, const LocalParameters& parameters,
                                   std::span<const EdgeValence> known, Stage& stage) {
  const std::vector<EdgeValence> knownEdges = sorted(known);
  std::vector<std::vector<SingularEdge>> blocks(blockCount(topology.pointCount, kGrain));
  parallelBlocks(
      stage, topology.pointCount, kGrain,
      [&](std::size_t begin, std::size_t end, std::size_t block) {
        std::vector<EdgeCorner> scratch;
        for (std::size_t i = begin; i < end; ++i) {
          const auto v = static_cast<Index>(i);
          forEachEdge(topology, v, scratch, [&](Index w, std::span<const EdgeCorner> fan) {
            const bool boundary = boundaryFacesAt(topology, fan) > 0;
            const int regular = boundary ? 2 : 4;
            const int hexes =
                known.empty() ? valence(parameters, fan) : regular + knownOffset(knownEdges, v, w);
            if (hexes == regular) return;
            blocks[block].push_back(
                {v, w, fan[0].tet, fan[0].corner0, fan[0].corner1, boundary, hexes});
          });
        }
      });
  Singularities result;
  for (const std::vector<SingularEdge>& block : blocks) {
    result.edges.insert(result.edges.end(), block.begin(), block.end());
  }
  indexByVertex(result, topology.pointCount);
  return result;
}

}  // namespace hexhex
