#include <algorithm>
#include <array>

#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <map/corner_rounder.hpp>
#include <map/tet_rounder.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// Where the coordinate across a boundary plane is among those of all corners.
struct Snap {
  std::uint8_t axis = 0;
  std::uint8_t perCorner = 0;
  std::uint8_t offset = 12;
};

/// By PlainVertices::plane: for one axis, or in vain.
constexpr std::array<Snap, 32> kSnaps = [] {
  std::array<Snap, 32> snaps{};
  for (std::uint8_t axis = 0; axis < 3; ++axis) snaps[std::size_t{1} << axis] = {axis, 3, axis};
  return snaps;
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
    Rounded rounded = roundedCorners(u);
    std::array<unsigned, 4> planes{};
    for (std::size_t i = 0; i < 4; ++i) planes[i] = plain_.plane[tet[i]];
    const unsigned anyPlane = planes[0] | planes[1] | planes[2] | planes[3];
    if (anyPlane != 0) snap(planes, u, rounded);
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
  /// Coordinates of all corners in units of the lattice, exact for integers below 2^53, and one
  /// entry for what is written in vain.
  using Rounded = std::array<double, 13>;

  [[nodiscard]] Rounded roundedCorners(const TetParameters& u) const {
    Rounded rounded;
    for (std::size_t n = 0; n < 12; n += 2) {
      const Pair x = Pair{u[n / 3][n % 3], u[(n + 1) / 3][(n + 1) % 3]} * unit_;
      const Pair nearest = nearestIntegers(x);
      rounded[n] = nearest[0];
      rounded[n + 1] = nearest[1];
    }
    return rounded;
  }

  static void store(const Rounded& rounded, LatticeTet& corners) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners[i][k] = static_cast<std::int64_t>(rounded[3 * i + k]);
      }
    }
  }

  /// Makes coordinates across boundary planes integers.
  void snap(const std::array<unsigned, 4>& planes, const TetParameters& u, Rounded& rounded) const {
    for (std::size_t i = 0; i < 4; ++i) {
      const Snap& snap = kSnaps[planes[i]];
      rounded[i * snap.perCorner + snap.offset] = nearestInteger(u[i][snap.axis]) * unit_;
    }
  }

  /// Without corners that are decided by their stars.
  [[nodiscard]] double displacementOfAll(const std::array<unsigned, 4>& planes,
                                         const TetParameters& u, const Rounded& rounded) const {
    Pair displacement = {0, 0};
    for (std::size_t i = 0; i < 4; i += 2) {
      Pair moved = {0, 0};
      for (std::size_t k = 0; k < 3; ++k) {
        const Pair before = {u[i][k], u[i + 1][k]};
        const Pair after = {rounded[3 * i + k], rounded[3 * i + 3 + k]};
        moved = larger(moved, magnitudeOf(after * resolution_ - before));
      }
      const Pair weight = {weightOf(planes[i]), weightOf(planes[i + 1])};
      displacement = larger(displacement, moved * weight);
    }
    return std::max(displacement[0], displacement[1]);
  }

  [[nodiscard]] static double weightOf(unsigned plane) {
    return kWeights[plane >= PlainVertices::kPlaneOfStar ? 0 : 1];
  }

  [[nodiscard]] bool isPositive(const Rounded& rounded, const LatticeTet& c) {
    if (measureVolume_) {
      const Int192 determinant = orientationDeterminant(c[0], c[1], c[2], c[3]);
      if (determinant.sign() <= 0) return false;
      sixfoldVolume_ += determinant;
      return true;
    }
    const auto corner = [&rounded](std::size_t i) {
      return Vec3{rounded[3 * i], rounded[3 * i + 1], rounded[3 * i + 2]};
    };
    const Vec3 origin = corner(0);
    return certainDeterminant(minus(corner(1), origin), minus(corner(2), origin),
                              minus(corner(3), origin)) > 0;
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
