#include <algorithm>
#include <array>

#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <map/corner_rounder.hpp>
#include <map/tet_rounder.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// By PlainVertices::plane and axis: all bits where the coordinate becomes an integer.
constexpr std::array<std::array<std::int64_t, 3>, 32> kSnapMasks = [] {
  std::array<std::array<std::int64_t, 3>, 32> masks{};
  for (std::size_t axis = 0; axis < 3; ++axis) masks[std::size_t{1} << axis][axis] = -1;
  return masks;
}();

/// Of corners that are decided by their stars, and of others.
constexpr std::array<double, 2> kWeights = {0, 1};

/// Rounds one tet after the other.
class TetRounder {
 public:
  TetRounder(const TetTopology& topology, const LocalParameters& parameters,
             const PlainVertices& plain, double tolerance, bool measureVolume,
             DefectCollector& defects, ExactMap& map)
      : topology_(topology),
        parameters_(parameters),
        plain_(plain),
        tolerance_(tolerance),
        measureVolume_(measureVolume),
        map_(map),
        unit_(static_cast<double>(map.unit)),
        resolution_(1 / unit_),
        rounder_(topology, tolerance, defects, map) {}

  /// Whether the tet is finished, and certainly positive.
  bool run(Index t) {
    const Tet& tet = topology_.tets[t];
    TetParameters scratch;
    const TetParameters& u = parameters_.see(t, scratch);
    std::array<unsigned, 4> planes{};
    for (std::size_t i = 0; i < 4; ++i) planes[i] = plain_.plane[tet[i]];
    const unsigned anyPlane = planes[0] | planes[1] | planes[2] | planes[3];
    const Rounded rounded = anyPlane == 0 ? roundedInside(u) : roundedAtPlanes(u, planes);
    LatticeTet& corners = map_.corners[t];
    store(rounded, corners);
    const double displacement = displacementOfAll(planes, u, rounded);
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    if (displacement > tolerance_) report(t, u);
    return anyPlane < PlainVertices::kPlaneOfStar && isPositive(rounded, corners);
  }

  [[nodiscard]] double maxDisplacement() const noexcept {
    return std::max(maxDisplacement_, rounder_.maxDisplacement());
  }
  /// Of all tets that are finished and positive, if asked for.
  [[nodiscard]] const Int192& sixfoldVolume() const noexcept { return sixfoldVolume_; }

 private:
  /// Coordinates in units of the lattice, exact for integers below 2^53: entry [i][k] has axis k of
  /// corners 2 i and 2 i + 1.
  using Rounded = std::array<std::array<Pair, 3>, 2>;

  [[nodiscard]] static Pair coordinates(const TetParameters& u, std::size_t i, std::size_t k) {
    return Pair{u[2 * i][k], u[2 * i + 1][k]};
  }

  [[nodiscard]] Rounded roundedInside(const TetParameters& u) const {
    Rounded rounded;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        rounded[i][k] = nearestIntegers(coordinates(u, i, k) * unit_);
      }
    }
    return rounded;
  }

  /// The same, but with integers across boundary planes.
  [[nodiscard]] Rounded roundedAtPlanes(const TetParameters& u,
                                        const std::array<unsigned, 4>& planes) const {
    Rounded rounded;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Pair x = coordinates(u, i, k);
        const PairMask isAcross = {kSnapMasks[planes[2 * i]][k], kSnapMasks[planes[2 * i + 1]][k]};
        rounded[i][k] = chosen(isAcross, nearestIntegers(x) * unit_, nearestIntegers(x * unit_));
      }
    }
    return rounded;
  }

  static void store(const Rounded& rounded, LatticeTet& corners) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners[2 * i][k] = static_cast<std::int64_t>(rounded[i][k][0]);
        corners[2 * i + 1][k] = static_cast<std::int64_t>(rounded[i][k][1]);
      }
    }
  }

  /// Without corners that are decided by their stars.
  [[nodiscard]] double displacementOfAll(const std::array<unsigned, 4>& planes,
                                         const TetParameters& u, const Rounded& rounded) const {
    Pair displacement = {0, 0};
    for (std::size_t i = 0; i < 2; ++i) {
      Pair moved = {0, 0};
      for (std::size_t k = 0; k < 3; ++k) {
        moved = larger(moved, magnitudeOf(rounded[i][k] * resolution_ - coordinates(u, i, k)));
      }
      const Pair weight = {weightOf(planes[2 * i]), weightOf(planes[2 * i + 1])};
      displacement = larger(displacement, moved * weight);
    }
    return std::max(displacement[0], displacement[1]);
  }

  [[nodiscard]] static double weightOf(unsigned plane) {
    return kWeights[plane >= PlainVertices::kPlaneOfStar ? 0 : 1];
  }

  [[nodiscard]] bool isPositive(const Rounded& rounded, const LatticeTet& corners) {
    if (measureVolume_) {
      const Int192 determinant =
          orientationDeterminant(corners[0], corners[1], corners[2], corners[3]);
      if (determinant.sign() <= 0) return false;
      sixfoldVolume_ += determinant;
      return true;
    }
    Vec3 a{};
    Vec3 b{};
    Vec3 c{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double origin = rounded[0][k][0];
      a[k] = rounded[0][k][1] - origin;
      b[k] = rounded[1][k][0] - origin;
      c[k] = rounded[1][k][1] - origin;
    }
    return certainDeterminant(a, b, c) > 0;
  }

  void report(Index t, const TetParameters& u) {
    const Tet& tet = topology_.tets[t];
    for (std::size_t i = 0; i < 4; ++i) {
      const unsigned plane = plain_.plane[tet[i]];
      if (plane >= PlainVertices::kPlaneOfStar) continue;
      rounder_.run(4 * t + static_cast<CornerIndex>(i), u[i], plane);
    }
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  const PlainVertices& plain_;
  double tolerance_;
  bool measureVolume_;
  ExactMap& map_;
  double unit_;
  double resolution_;
  CornerRounder rounder_;
  double maxDisplacement_ = 0;
  Int192 sixfoldVolume_;
};

}  // namespace

RoundedTets roundTets(const TetTopology& topology, const LocalParameters& parameters,
                      const PlainVertices& plain, double tolerance, bool measureVolume,
                      Stage& stage, DefectCollector& defects, ExactMap& map) {
  const std::size_t blocks = blockCount(topology.tetCount(), kGrain);
  RoundedTets result;
  result.unfinished.resize(blocks);
  std::vector<double> displacements(blocks);
  std::vector<Int192> volumes(blocks);
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   TetRounder rounder(topology, parameters, plain, tolerance, measureVolume,
                                      defects, map);
                   std::array<Index, kGrain + 1> list;  // NOLINT: written before it is read
                   std::size_t count = 0;
                   for (std::size_t t = begin; t < end; ++t) {
                     list[count] = static_cast<Index>(t);
                     count += rounder.run(static_cast<Index>(t)) ? 0 : 1;
                   }
                   result.unfinished[block].assign(list.begin(), list.begin() + count);
                   displacements[block] = rounder.maxDisplacement();
                   volumes[block] = rounder.sixfoldVolume();
                 });
  for (std::size_t block = 0; block < blocks; ++block) {
    map.maxDisplacement = std::max(map.maxDisplacement, displacements[block]);
    result.sixfoldVolume += volumes[block];
  }
  return result;
}

}  // namespace hexhex
