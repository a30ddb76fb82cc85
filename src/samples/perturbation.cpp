// Moves one vertex of a grid of tets at a time: jitter and rounding undo moves that come too close
// to flipping a tet, damage keeps moves that flip some.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <base/random.hpp>
#include <base/vector3.hpp>
#include <samples/steps.hpp>

namespace hexhex::samples {

namespace {

/// Least determinant of a moved tet, relative to the cubed length of a sub-block: thin tets are
/// welcome, but their volume must stay far above the rounding errors of this file (1e-15).
constexpr double kLeastShare = 1e-6;
/// Number of times that a shift is halved before it is given up.
constexpr int kHalvings = 4;
/// Number of candidate moves drawn to damage a vertex; the best one is kept.
constexpr int kDraws = 24;
/// Independent streams of random numbers.
constexpr std::uint64_t kJitterStream = 1;
constexpr std::uint64_t kRoundingStream = 2;
constexpr std::uint64_t kDamageStream = 5;

/// A vertex that may move: the copies of its parameters, and the sub-blocks that it shapes.
struct Site {
  struct Copy {
    Int3* parameter = nullptr;
    lattice::Rotation fromFirst;
  };
  Index vertex = 0;
  std::vector<Copy> copies;
  std::vector<std::size_t> subBlocks;
  std::array<bool, 3> free{};  ///< axes of the first copy
  bool inside = false;         ///< may move in space
  bool singular = false;       ///< inside a singular coarse edge

  /// Moves the parameters in the same way in all charts.
  /// @param shift  in units, in the chart of the first copy
  void moveInMap(const Int3& shift) const {
    for (const Copy& copy : copies) *copy.parameter = *copy.parameter + copy.fromFirst(shift);
  }
  /// Up to `limit` along each free axis.
  [[nodiscard]] Int3 drawShift(std::int64_t limit, Random& random) const {
    Int3 shift{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t drawn = random.integerUpTo(limit);
      if (free[a]) shift[a] = drawn;
    }
    return shift;
  }
};

/// Adds the sub-blocks of a block that touch a grid point.
void addSubBlocksAround(const TetGrid& grid, std::size_t block, const Int3& at,
                        std::vector<std::size_t>& subBlocks) {
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Int3 low = at;
    bool exists = true;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] -= static_cast<std::int64_t>(corner >> a & 1);
      exists = exists && low[a] >= 0 && low[a] < grid.refine();
    }
    if (exists) subBlocks.push_back(grid.subBlock(block, low));
  }
}

/// Calls f(site) for every vertex that can move in any way, in a fixed order.
template <class F>
void forEachSite(TetGrid& grid, const BlockComplex& complex, const F& f) {
  Site site;
  Index vertex = 0;
  for (const CoarseCell& cell : complex.cells()) {
    site.free = cell.free;
    site.inside = !cell.boundary;
    site.singular = cell.dimension == 1 && cell.singular();
    for (std::size_t point = 0; point < grid.innerPointCount(cell.dimension); ++point) {
      site.vertex = vertex++;
      site.copies.clear();
      site.subBlocks.clear();
      for (const Occurrence& occurrence : cell.occurrences) {
        const Int3 at = grid.gridPoint(occurrence, cell.dimension, point);
        site.copies.push_back(
            {&grid.parameters[grid.slot(occurrence.block, at)], occurrence.fromFirst});
        addSubBlocksAround(grid, occurrence.block, at, site.subBlocks);
      }
      f(site);
    }
  }
  site.free = {true, true, true};
  site.inside = true;
  site.singular = false;
  for (std::size_t sub = 0; sub < grid.subBlockCount(); ++sub) {
    site.vertex = grid.centreVertex(sub);
    site.copies.assign(1, {&grid.centreParameters[sub], {}});
    site.subBlocks.assign(1, sub);
    f(site);
  }
}

/// Whether test(a, b, c) holds for all tets around a site, with the centre of its sub-block as the
/// origin.
/// @param cornersOf  &TetGrid::cornersInMap or &TetGrid::cornersInSpace
template <class Test>
bool holdsAround(const Site& site, const TetGrid& grid,
                 std::array<Vec3, 8> (TetGrid::*cornersOf)(std::size_t subBlock) const,
                 const Test& test) {
  return std::all_of(site.subBlocks.begin(), site.subBlocks.end(), [&](std::size_t sub) {
    const std::array<Vec3, 8> corners = (grid.*cornersOf)(sub);
    const auto triangles = surfaceTriangles(grid.cornerVertices(sub));
    return std::all_of(triangles.begin(), triangles.end(), [&](const SurfaceTriangle& t) {
      return test(corners[t[0]], corners[t[1]], corners[t[2]]);
    });
  });
}

double cube(double a) { return a * a * a; }
double absoluteSum(const Vec3& a) { return std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]); }

/// The length of a sub-block in units.
double subBlockUnits(const TetGrid& grid) {
  return static_cast<double>(grid.cells() * kUnitsPerCell) / static_cast<double>(grid.refine());
}

/// Bounds the change of det(a, b, c) if every entry changes by up to `change`, from the expansion
/// of the determinant: one, two, or three changed vectors in each product.
double largestChange(const Vec3& a, const Vec3& b, const Vec3& c, double change) {
  const double one = absoluteSum(cross(a, b)) + absoluteSum(cross(b, c)) + absoluteSum(cross(c, a));
  const double two = absoluteSum(a) + absoluteSum(b) + absoluteSum(c);
  return change * (one + change * (2 * two + change * 4));
}

/// Moves sites, and undoes moves that flip a tet.
class Mover {
 public:
  Mover(TetGrid& grid, double noise)
      : grid_(grid),
        // A difference of two corners changes by twice the noise of one.
        noise_(2 * kNoiseReserve * noise * static_cast<double>(kUnitsPerCell)),
        leastInMap_(kLeastShare * cube(subBlockUnits(grid))),
        // Block edges have a length of about one in space.
        leastInSpace_(kLeastShare / cube(static_cast<double>(grid.refine()))) {}

  bool moveInMap(const Site& site, const Int3& shift) {
    if (shift == Int3{}) return true;
    site.moveInMap(shift);
    const auto isPositive = [this](const Vec3& a, const Vec3& b, const Vec3& c) {
      const double reserve = noise_ > 0 ? largestChange(a, b, c, noise_) : 0;
      return tripleProduct(a, b, c) > leastInMap_ + reserve;
    };
    if (holdsAround(site, grid_, &TetGrid::cornersInMap, isPositive)) return true;
    site.moveInMap(Int3{} - shift);
    return false;
  }

  bool moveInSpace(const Site& site, const Vec3& shift) {
    Vec3& point = grid_.points[site.vertex];
    const Vec3 before = point;
    point = plus(point, shift);
    const auto isPositive = [this](const Vec3& a, const Vec3& b, const Vec3& c) {
      return tripleProduct(a, b, c) > leastInSpace_;
    };
    if (holdsAround(site, grid_, &TetGrid::cornersInSpace, isPositive)) return true;
    point = before;
    return false;
  }

  /// The shortest distance in space from the site to a surrounding centre (or to a corner, if it is
  /// a centre itself).
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
  TetGrid& grid_;
  double noise_;
  double leastInMap_;
  double leastInSpace_;
};

/// Calls move(shift), with the shift halved each time, until it succeeds.
template <class Shift, class Move>
void moveAsFarAsPossible(Shift shift, const Move& move) {
  for (int attempt = 0; attempt <= kHalvings; ++attempt) {
    if (move(shift)) return;
    for (auto& coordinate : shift) coordinate /= 2;
  }
}

Vec3 drawShiftInSpace(double limit, Random& random) {
  Vec3 shift{};
  for (double& coordinate : shift) coordinate = random.realUpTo(limit);
  return shift;
}

/// The difference from the nearest integer, in units.
std::int64_t toNearestInteger(std::int64_t parameter) {
  const std::int64_t above = ((parameter % kUnitsPerCell) + kUnitsPerCell) % kUnitsPerCell;
  return 2 * above < kUnitsPerCell ? -above : kUnitsPerCell - above;
}

/// All three coordinates half of the time, otherwise any nonempty choice. A choice that would flip
/// a tet is retried coordinate by coordinate.
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

/// Folds the tets around one site after another.
class Damager {
 public:
  Damager(TetGrid& grid, DefectKind kind, std::uint64_t seed)
      : grid_(grid), kind_(kind), random_(seed, kDamageStream) {}

  /// @param sites  of the requested kind
  void run(std::vector<Site> sites, int tets) {
    const Vec3 centre = grid_.points[sites[random_.below(sites.size())].vertex];
    const auto squaredDistance = [&](const Site& site) {
      const Vec3 d = minus(grid_.points[site.vertex], centre);
      return dot(d, d);
    };
    std::sort(sites.begin(), sites.end(), [&](const Site& a, const Site& b) {
      const double da = squaredDistance(a);
      const double db = squaredDistance(b);
      return da != db ? da < db : a.vertex < b.vertex;
    });
    int bad = 0;
    for (const Site& site : sites) {
      if (bad >= tets) return;
      bad += damageSite(site, tets - bad);
    }
    if (bad > 0) return;
    throw Error(ErrorCode::InvalidArgument,
                "The sample could not be damaged: no vertex of the wanted kind has room to fold "
                "its tets. Raise 'refine'.");
  }

 private:
  /// Moves one vertex so that about `wanted` more tets are bad; returns their actual number.
  int damageSite(const Site& site, int wanted) {
    // Anywhere within one and a half sub-blocks.
    const auto limit = static_cast<std::int64_t>(1.5 * subBlockUnits(grid_));
    const int before = badTets(site);
    Int3 best{};
    int bestGain = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Int3 shift =
          kind_ == DefectKind::Sliver ? drawCollapse(site) : site.drawShift(limit, random_);
      site.moveInMap(shift);
      const int gain = badTets(site) - before;
      site.moveInMap(Int3{} - shift);
      if (gain <= 0) continue;
      if (bestGain == 0 || std::abs(gain - wanted) < std::abs(bestGain - wanted)) {
        best = shift;
        bestGain = gain;
      }
    }
    site.moveInMap(best);
    return bestGain;
  }

  /// Onto a corner of a sub-block at the site, or midway between two: edges collapse, tets become
  /// flat. For sites with a single chart.
  Int3 drawCollapse(const Site& site) {
    const std::size_t sub = site.subBlocks[random_.below(site.subBlocks.size())];
    const std::array<Int3, 8> corners = grid_.cornerParameters(sub);
    const Int3& a = corners[random_.below(8)];
    const Int3& b = random_.below(2) == 0 ? a : corners[random_.below(8)];
    const Int3& own = *site.copies.front().parameter;
    Int3 shift{};
    for (std::size_t k = 0; k < 3; ++k) shift[k] = (a[k] + b[k]) / 2 - own[k];
    return shift;
  }

  [[nodiscard]] int badTets(const Site& site) const {
    int bad = 0;
    const auto count = [&bad](const Vec3& a, const Vec3& b, const Vec3& c) {
      bad += tripleProduct(a, b, c) > 0 ? 0 : 1;
      return true;
    };
    holdsAround(site, grid_, &TetGrid::cornersInMap, count);
    return bad;
  }

  TetGrid& grid_;
  DefectKind kind_;
  Random random_;
};

bool isOfKind(const Site& site, DefectKind kind) {
  const bool movable = site.free[0] || site.free[1] || site.free[2];
  const bool free = site.free[0] && site.free[1] && site.free[2];
  switch (kind) {
    case DefectKind::Interior:
      return site.inside && free;
    case DefectKind::Singular:
      return site.singular && movable;
    case DefectKind::Boundary:
      return !site.inside && movable;
    case DefectKind::Sliver:
      return site.inside && free && site.copies.size() == 1;
  }
  return false;
}

}  // namespace

void jitter(TetGrid& grid, const BlockComplex& complex, double share, double noise,
            std::uint64_t seed) {
  Mover mover(grid, noise);
  Random random(seed, kJitterStream);
  const auto limit = static_cast<std::int64_t>(share * subBlockUnits(grid));
  forEachSite(grid, complex, [&](const Site& site) {
    moveAsFarAsPossible(site.drawShift(limit, random),
                        [&](const Int3& shift) { return mover.moveInMap(site, shift); });
    if (!site.inside) return;
    moveAsFarAsPossible(drawShiftInSpace(share * mover.roomInSpace(site), random),
                        [&](const Vec3& shift) { return mover.moveInSpace(site, shift); });
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

void damage(TetGrid& grid, const BlockComplex& complex, DefectKind kind, int tets,
            std::uint64_t seed) {
  std::vector<Site> sites;
  forEachSite(grid, complex, [&](const Site& site) {
    if (isOfKind(site, kind)) sites.push_back(site);
  });
  if (sites.empty()) {
    throw Error(ErrorCode::InvalidArgument,
                "The sample has no vertex that damage of this kind could move. Raise 'refine' to 2 "
                "or more, or choose another kind of sample or defect.");
  }
  Damager(grid, kind, seed).run(std::move(sites), tets);
}

}  // namespace hexhex::samples
