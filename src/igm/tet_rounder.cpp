#include <algorithm>
#include <array>

#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <igm/map_conditions.hpp>
#include <igm/tet_rounder.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// The twelve coordinates of a tet, corner by corner.
using Coordinates = std::array<Pair, 6>;

Coordinates inARow(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {loadPair(&a[0]), Pair{a[2], b[0]}, loadPair(&b[1]),
          loadPair(&c[0]), Pair{c[2], d[0]}, loadPair(&d[1])};
}

Vec3 cornerOf(const Coordinates& coordinates, std::size_t corner) {
  const auto number = [&](std::size_t i) { return coordinates[i / 2][i % 2]; };
  return {number(3 * corner), number(3 * corner + 1), number(3 * corner + 2)};
}

/// Rounds one tet after the other.
class TetRounder {
 public:
  TetRounder(const TetTopology& topology, const LocalParameters& parameters,
             std::span<const Rounding> rounding, const Grains& grains, bool measureVolume,
             ExactMap& map)
      : topology_(topology),
        parameters_(parameters),
        rounding_(rounding),
        grains_(grains),
        measureVolume_(measureVolume),
        map_(map),
        unit_(static_cast<double>(map.unit)),
        resolution_(1 / unit_),
        leastDeterminant_(leastCertainDeterminant(parameters, unit_)) {}

  /// Whether the tet is finished, and certainly positive.
  bool run(Index t) {
    const Tet& tet = topology_.tets[t];
    TetParameters scratch;
    const TetParameters& u = parameters_.see(t, scratch);
    const Coordinates given = inARow(u[0], u[1], u[2], u[3]);
    std::array<Rounding, 4> rounding{};
    for (std::size_t i = 0; i < 4; ++i) rounding[i] = rounding_[tet[i]];
    const Coordinates large = inARow(grains_.at(rounding[0]), grains_.at(rounding[1]),
                                     grains_.at(rounding[2]), grains_.at(rounding[3]));
    Coordinates rounded;
    for (std::size_t i = 0; i < 6; ++i) {
      rounded[i] = nearestMultiples(given[i] * unit_, large[i]);
      displacement_ = larger(displacement_, magnitudeOf(rounded[i] * resolution_ - given[i]));
    }
    LatticeTet& corners = map_.corners[t];
    store(rounded, corners);
    const bool isFinished = std::ranges::find(rounding, Rounding::ByStar) == rounding.end();
    return isFinished && isPositive(rounded, corners);
  }

  /// Without corners that are decided by their stars.
  [[nodiscard]] double maxDisplacement() const noexcept {
    return std::max(displacement_[0], displacement_[1]);
  }
  /// Of all tets that are finished and positive, if asked for.
  [[nodiscard]] const Int192& sixfoldVolume() const noexcept { return sixfoldVolume_; }

 private:
  static void store(const Coordinates& rounded, LatticeTet& corners) {
    for (std::size_t i = 0; i < 12; ++i) {
      corners[i / 3][i % 3] = static_cast<std::int64_t>(rounded[i / 2][i % 2]);
    }
  }

  [[nodiscard]] bool isPositive(const Coordinates& rounded, const LatticeTet& corners) {
    if (measureVolume_) {
      const Int192 determinant =
          orientationDeterminant(corners[0], corners[1], corners[2], corners[3]);
      if (determinant.sign() <= 0) return false;
      sixfoldVolume_ += determinant;
      return true;
    }
    const Vec3 origin = cornerOf(rounded, 0);
    return tripleProduct(minus(cornerOf(rounded, 1), origin), minus(cornerOf(rounded, 2), origin),
                         minus(cornerOf(rounded, 3), origin)) > leastDeterminant_;
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  std::span<const Rounding> rounding_;
  const Grains& grains_;
  bool measureVolume_;
  ExactMap& map_;
  double unit_;
  double resolution_;
  double leastDeterminant_;
  Pair displacement_ = {0, 0};
  Int192 sixfoldVolume_;
};

/// Reports corners that have moved too far.
void reportDisplacements(const TetTopology& topology, const LocalParameters& parameters,
                         std::span<const Rounding> rounding, std::size_t begin, std::size_t end,
                         CornerRounder& rounder) {
  for (auto corner = static_cast<CornerIndex>(4 * begin); corner < 4 * end; ++corner) {
    const Rounding how = rounding[topology.vertex(corner)];
    if (how == Rounding::ByStar) continue;
    rounder.run(corner, parameters(tetOf(corner), localOf(corner)), how);
  }
}

}  // namespace

RoundedTets roundTets(const TetTopology& topology, const LocalParameters& parameters,
                      std::span<const Rounding> rounding, double tolerance, bool measureVolume,
                      Stage& stage, DefectCollector& defects, ExactMap& map) {
  const std::size_t blocks = blockCount(topology.tetCount(), kGrain);
  RoundedTets result;
  result.unfinished.resize(blocks);
  std::vector<double> displacements(blocks);
  std::vector<Int192> volumes(blocks);
  const Grains grains(static_cast<double>(map.unit));
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   TetRounder rounder(topology, parameters, rounding, grains, measureVolume, map);
                   std::array<Index, kGrain + 1> list;  // NOLINT: written before it is read
                   std::size_t count = 0;
                   for (std::size_t t = begin; t < end; ++t) {
                     list[count] = static_cast<Index>(t);
                     count += rounder.run(static_cast<Index>(t)) ? 0 : 1;
                   }
                   result.unfinished[block].assign(list.begin(), list.begin() + count);
                   displacements[block] = rounder.maxDisplacement();
                   if (displacements[block] > tolerance) {
                     CornerRounder reporter(topology, tolerance, defects, map);
                     reportDisplacements(topology, parameters, rounding, begin, end, reporter);
                   }
                   volumes[block] = rounder.sixfoldVolume();
                 });
  for (std::size_t block = 0; block < blocks; ++block) {
    map.maxDisplacement = std::max(map.maxDisplacement, displacements[block]);
    result.sixfoldVolume += volumes[block];
  }
  return result;
}

}  // namespace hexhex
