// Draws moves of one vertex after the other, and keeps those that flip neither none nor too many
// tets.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <base/vector3.hpp>
#include <samples/damage.hpp>
#include <samples/random.hpp>
#include <samples/sites.hpp>

namespace hexhex::samples {

namespace {

constexpr std::uint64_t kDamageStream = 5;
/// How many moves of a vertex are drawn; the one that comes nearest to what is wanted is kept.
constexpr int kDraws = 24;

double squaredDistance(const Vec3& a, const Vec3& b) {
  const Vec3 d = minus(a, b);
  return dot(d, d);
}

class Damager {
 public:
  Damager(TetGrid& grid, DefectKind kind, std::uint64_t seed)
      : grid_(grid), kind_(kind), random_(seed, kDamageStream) {}

  /// @param sites  of the kind
  void run(std::vector<Site> sites, int tets) {
    const Vec3 centre = grid_.points[sites[random_.below(sites.size())].vertex];
    std::sort(sites.begin(), sites.end(), [&](const Site& a, const Site& b) {
      const double da = squaredDistance(grid_.points[a.vertex], centre);
      const double db = squaredDistance(grid_.points[b.vertex], centre);
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
  /// Moves one vertex such that about `wanted` more tets are bad; returns how many are.
  int damageSite(const Site& site, int wanted) {
    const int before = badTets(site);
    Int3 best{};
    int bestGain = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Int3 shift = kind_ == DefectKind::Sliver ? drawCollapse(site) : drawShift(site);
      move(site, shift, 1);
      const int gain = badTets(site) - before;
      move(site, shift, -1);
      if (gain <= 0) continue;
      if (bestGain == 0 || std::abs(gain - wanted) < std::abs(bestGain - wanted)) {
        best = shift;
        bestGain = gain;
      }
    }
    if (bestGain > 0) move(site, best, 1);
    return bestGain;
  }

  static void move(const Site& site, const Int3& shift, std::int64_t sign) {
    for (const Site::Copy& copy : site.copies) {
      const Int3 own = copy.fromFirst(shift);
      for (std::size_t a = 0; a < 3; ++a) (*copy.parameter)[a] += sign * own[a];
    }
  }

  /// Anywhere up to one and a half sub-blocks away, along the free axes.
  Int3 drawShift(const Site& site) {
    const auto limit =
        static_cast<std::int64_t>(1.5 * static_cast<double>(grid_.cells() * kUnitsPerCell) /
                                  static_cast<double>(grid_.refine()));
    Int3 shift{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t drawn = random_.integerUpTo(limit);
      if (site.free[a]) shift[a] = drawn;
    }
    return shift;
  }

  /// Onto a corner of a sub-block at the site, or in the middle between two: edges collapse, tets
  /// become flat. Of sites with one chart only.
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
    for (const std::size_t sub : site.subBlocks) {
      const std::array<Vec3, 8> corners = grid_.cornersInMap(sub);
      for (const SurfaceTriangle& t : surfaceTriangles(grid_.cornerVertices(sub))) {
        const double det = tripleProduct(corners[t[0]], corners[t[1]], corners[t[2]]);
        bad += det > 0 ? 0 : 1;
      }
    }
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
