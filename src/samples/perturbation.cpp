// Moves one vertex at a time and takes back what comes too close to flipping a tet.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <base/vector3.hpp>
#include <samples/perturbation.hpp>
#include <samples/random.hpp>
#include <samples/sites.hpp>

namespace hexhex::samples {

namespace {

/// Least determinant of a moved tet, as a share of the cube of the length of a sub-block: thin tets
/// are wanted, but their volume has to stay far above the rounding errors of this file (1e-15).
constexpr double kLeastShare = 1e-6;
/// How often a shift is halved before it is given up.
constexpr int kHalvings = 4;
/// Independent streams of random numbers for the two perturbations.
constexpr std::uint64_t kJitterStream = 1;
constexpr std::uint64_t kRoundingStream = 2;

double cube(double a) { return a * a * a; }
double absoluteSum(const Vec3& a) { return std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]); }

/// A bound for the change of det(a, b, c) if every entry changes by up to `change`, from the
/// expansion of the determinant: one, two, or three changed vectors in each product.
double largestChange(const Vec3& a, const Vec3& b, const Vec3& c, double change) {
  const double one = absoluteSum(cross(a, b)) + absoluteSum(cross(b, c)) + absoluteSum(cross(c, a));
  const double two = absoluteSum(a) + absoluteSum(b) + absoluteSum(c);
  return change * (one + change * (2 * two + change * 4));
}

/// Moves sites, and takes back what flips a tet.
class Mover {
 public:
  Mover(TetGrid& grid, double noise)
      : grid_(grid),
        // A difference of two corners changes by twice the noise of one.
        noise_(2 * kNoiseReserve * noise * static_cast<double>(kUnitsPerCell)),
        leastInMap_(kLeastShare * cube(subBlockUnits(grid))),
        // Block edges have a length of about one in space.
        leastInSpace_(kLeastShare / cube(static_cast<double>(grid.refine()))) {}

  /// The length of a sub-block in units.
  static double subBlockUnits(const TetGrid& grid) {
    return static_cast<double>(grid.cells() * kUnitsPerCell) / static_cast<double>(grid.refine());
  }

  /// @param shift  in units, in the chart of the first copy
  bool moveInMap(const Site& site, const Int3& shift) {
    if (shift == Int3{}) return true;
    for (const Site::Copy& copy : site.copies) {
      *copy.parameter = *copy.parameter + copy.fromFirst(shift);
    }
    if (positiveInMap(site)) return true;
    for (const Site::Copy& copy : site.copies) {
      *copy.parameter = *copy.parameter - copy.fromFirst(shift);
    }
    return false;
  }

  bool moveInSpace(const Site& site, const Vec3& shift) {
    Vec3& point = grid_.points[site.vertex];
    const Vec3 before = point;
    for (std::size_t a = 0; a < 3; ++a) point[a] += shift[a];
    if (positiveInSpace(site)) return true;
    point = before;
    return false;
  }

  /// The shortest distance in space from the site to a centre around it (or to a corner, if it is a
  /// centre itself).
  [[nodiscard]] double roomInSpace(const Site& site) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t sub : site.subBlocks) {
      const std::array<Index, 8> ids = grid_.cornerVertices(sub);
      const std::array<Vec3, 8> corners = grid_.cornersInSpace(sub);
      const bool isCentre = grid_.centreVertex(sub) == site.vertex;
      for (std::size_t c = 0; c < 8; ++c) {
        if (isCentre || ids[c] == site.vertex) least = std::min(least, dot(corners[c], corners[c]));
      }
    }
    return std::sqrt(least);
  }

 private:
  [[nodiscard]] bool positiveInMap(const Site& site) const {
    return std::all_of(site.subBlocks.begin(), site.subBlocks.end(), [this](std::size_t sub) {
      const std::array<Vec3, 8> corners = grid_.cornersInMap(sub);
      for (const SurfaceTriangle& t : surfaceTriangles(grid_.cornerVertices(sub))) {
        const Vec3& a = corners[t[0]];
        const Vec3& b = corners[t[1]];
        const Vec3& c = corners[t[2]];
        const double least =
            noise_ > 0 ? leastInMap_ + largestChange(a, b, c, noise_) : leastInMap_;
        if (!(tripleProduct(a, b, c) > least)) return false;
      }
      return true;
    });
  }

  [[nodiscard]] bool positiveInSpace(const Site& site) const {
    return std::all_of(site.subBlocks.begin(), site.subBlocks.end(), [this](std::size_t sub) {
      const std::array<Vec3, 8> corners = grid_.cornersInSpace(sub);
      for (const SurfaceTriangle& t : surfaceTriangles(grid_.cornerVertices(sub))) {
        const double det = tripleProduct(corners[t[0]], corners[t[1]], corners[t[2]]);
        if (!(det > leastInSpace_)) return false;
      }
      return true;
    });
  }

  TetGrid& grid_;
  double noise_;
  double leastInMap_;
  double leastInSpace_;
};

void jitterInMap(Mover& mover, const Site& site, std::int64_t limit, Random& random) {
  Int3 shift{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t drawn = random.integerUpTo(limit);
    if (site.free[a]) shift[a] = drawn;
  }
  for (int attempt = 0; attempt <= kHalvings; ++attempt) {
    if (mover.moveInMap(site, shift)) return;
    for (std::int64_t& coordinate : shift) coordinate /= 2;
  }
}

void jitterInSpace(Mover& mover, const Site& site, double share, Random& random) {
  const double limit = share * mover.roomInSpace(site);
  Vec3 shift{};
  for (double& coordinate : shift) coordinate = random.realUpTo(limit);
  for (int attempt = 0; attempt <= kHalvings; ++attempt) {
    if (mover.moveInSpace(site, shift)) return;
    for (double& coordinate : shift) coordinate /= 2;
  }
}

/// What is missing to the nearest integer, in units.
std::int64_t toNearestInteger(std::int64_t parameter) {
  const std::int64_t above = ((parameter % kUnitsPerCell) + kUnitsPerCell) % kUnitsPerCell;
  return 2 * above < kUnitsPerCell ? -above : kUnitsPerCell - above;
}

/// All three coordinates half of the time, else any nonempty choice. A choice that would flip a tet
/// is tried coordinate by coordinate.
void roundSite(Mover& mover, const Site& site, Random& random) {
  const std::uint64_t choice = random.below(2) == 0 ? 7 : 1 + random.below(7);
  Int3 shift{};
  for (std::size_t a = 0; a < 3; ++a) {
    const bool chosen = site.free[a] && (choice >> a & 1) == 1;
    if (chosen) shift[a] = toNearestInteger((*site.copies.front().parameter)[a]);
  }
  if (mover.moveInMap(site, shift)) return;
  for (std::size_t a = 0; a < 3; ++a) {
    Int3 single{};
    single[a] = shift[a];
    mover.moveInMap(site, single);
  }
}

}  // namespace

void jitter(TetGrid& grid, const BlockComplex& complex, double share, double noise,
            std::uint64_t seed) {
  Mover mover(grid, noise);
  Random random(seed, kJitterStream);
  const auto limit = static_cast<std::int64_t>(share * Mover::subBlockUnits(grid));
  forEachSite(grid, complex, [&](const Site& site) {
    jitterInMap(mover, site, limit, random);
    if (site.inside) jitterInSpace(mover, site, share, random);
  });
}

void roundToLattice(TetGrid& grid, const BlockComplex& complex, double share, double noise,
                    std::uint64_t seed) {
  Mover mover(grid, noise);
  Random random(seed, kRoundingStream);
  forEachSite(grid, complex, [&](const Site& site) {
    if (random.share() < share) roundSite(mover, site, random);
  });
}

}  // namespace hexhex::samples
