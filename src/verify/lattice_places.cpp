#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>

#include <verify/lattice_places.hpp>

#include <base/vector3.hpp>
#include <base/workspaces.hpp>

namespace hexhex::verification {

namespace {

/// Bound of a position's error, relative to the coordinates of its tet: a few roundings, plus the
/// conversion to text with 17 digits.
constexpr double kSpaceOfTetRounding = 0x1p-48;
/// Weights that lose more digits than this are computed exactly. Extraction does so from 2^20 on by
/// its own measure, which is at least a sixth of the measure used here.
constexpr double kMaxCondition = 0x1p23;

}  // namespace

SpaceOfTet::SpaceOfTet(const igm::PreparedMap& map, Index tet)
    : corners_(map.exact.corners[tet]), unit_(map.exact.unit) {
  const double perUnit = 1.0 / static_cast<double>(unit_);
  double largest = 0;
  Vec3 extent{};
  for (std::size_t i = 0; i < 4; ++i) {
    points_[i] = map.input.view.points[map.topology.tets[tet][i]];
    for (std::size_t k = 0; k < 3; ++k) {
      largest = std::max(largest, std::abs(points_[i][k]));
      extent[k] = std::max(
          extent[k], std::abs(static_cast<double>(corners_[i][k] - corners_[0][k])) * perUnit);
    }
  }
  std::array<Vec3, 3> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges[i][k] = static_cast<double>(corners_[i + 1][k] - corners_[0][k]) * perUnit;
    }
  }
  // Weight i + 1 of a point u is normals[i] . (u - corner 0) / determinant.
  const std::array<Vec3, 3> normals = {cross(edges[1], edges[2]), cross(edges[2], edges[0]),
                                       cross(edges[0], edges[1])};
  const double determinant = dot(edges[0], normals[0]);
  double condition = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = static_cast<std::int32_t>(corners_[0][k] / unit_);
    for (std::size_t i = 0; i < 3; ++i) {
      condition += std::abs(normals[i][k]) * (extent[k] + 1);
      for (std::size_t j = 0; j < 3; ++j) {
        steps_[k][j] += (points_[i + 1][j] - points_[0][j]) * (normals[i][k] / determinant);
      }
    }
  }
  condition = 1 + condition / determinant;
  isFlat_ = !(determinant > 0) || !(condition < kMaxCondition);
  // Below 2^-1022, numbers lose digits.
  error_ = largest * kSpaceOfTetRounding * (isFlat_ ? 1 : condition) +
           0x1p-1070 * (8 + extent[0] + extent[1] + extent[2]);
  atOrigin_ = points_[0];
  for (std::size_t k = 0; k < 3; ++k) {
    const double offset = static_cast<double>(origin_[k] * unit_ - corners_[0][k]) * perUnit;
    for (std::size_t j = 0; j < 3; ++j) atOrigin_[j] += steps_[k][j] * offset;
  }
}

Vec3 SpaceOfTet::preimage(const lattice::GridPoint& z) const {
  Vec3 q = atOrigin_;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto offset = static_cast<double>(z[k] - origin_[k]);
    for (std::size_t j = 0; j < 3; ++j) q[j] += steps_[k][j] * offset;
  }
  return q;
}

/// With exact weights, each rounded once.
Vec3 SpaceOfTet::exactly(const lattice::GridPoint& z) const {
  const lattice::LatticePoint u = {z[0] * unit_, z[1] * unit_, z[2] * unit_};
  std::array<double, 4> weights{};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::array<int, 3>& f = lattice::kFaceCorners[i];
    weights[i] = lattice::orientationDeterminant(corners_[static_cast<std::size_t>(f[0])],
                                                 corners_[static_cast<std::size_t>(f[1])],
                                                 corners_[static_cast<std::size_t>(f[2])], u)
                     .toDouble();
    sum += weights[i];
  }
  Vec3 q{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 3; ++j) q[j] += points_[i][j] * (weights[i] / sum);
  }
  return q;
}

bool areInTet(const igm::PreparedMap& map, const FaceSides& sides,
              std::span<const lattice::SweptLine> lines, std::int64_t shift) {
  const auto simplexOf = [&](const lattice::SweptLine& line, std::uint32_t i) {
    const lattice::GridPoint z = line.point(i);
    lattice::LatticePoint point;
    for (std::size_t k = 0; k < 3; ++k) point[k] = z[k] * map.exact.unit + shift;
    return sides.simplexOf(point);
  };
  const lattice::SweptLine* before = nullptr;
  for (const lattice::SweptLine& line : lines) {
    if (before != nullptr &&
        std::pair(before->level, before->row) >= std::pair(line.level, line.row)) {
      return false;
    }
    before = &line;
    if (line.count == 0 || simplexOf(line, 0) != line.left ||
        (line.count > 1 && simplexOf(line, line.count - 1) != line.right)) {
      return false;
    }
  }
  return true;
}

std::pair<std::size_t, std::size_t> tetsWith(const Array<std::uint64_t>& begin, std::uint64_t first,
                                             std::uint64_t end) {
  const auto low = std::upper_bound(begin.begin(), begin.end(), first) - 1;
  const auto high = std::lower_bound(low, begin.end() - 1, end);
  return {static_cast<std::size_t>(low - begin.begin()),
          static_cast<std::size_t>(high - begin.begin())};
}

LatticePlaces::LatticePlaces(const igm::PreparedMap& map, Stage& stage)
    : map_(map), swept_(sweep::sweepVertices(map, stage)), begin_(swept_.numbers.begin), runs_(0) {}

LatticePlaces::LatticePlaces(const igm::PreparedMap& map, const sweep::VertexNumbers& numbers)
    : map_(map),
      swept_{sweep::TetLines(0), {}},
      given_(&numbers),
      begin_(numbers.begin),
      runs_(0) {}

void LatticePlaces::collectRuns(Index tet, const sweep::VertexNumbers& numbers,
                                std::span<const lattice::SweptLine> lines,
                                std::vector<PlaceRun>& runs) const {
  if (lines.empty()) return;
  const auto firstRun = static_cast<std::ptrdiff_t>(runs.size());
  sweep::TetNumbering(map_, numbers, tet, lines.front().axes)
      .run(lines, [&](const sweep::VertexRun& run) {
        if (!run.owned) return;
        runs.push_back({static_cast<Index>(run.first - begin_[tet]), run.count,
                        run.line->point(run.offset), run.simplex, run.line->axes()[2]});
      });
  // Points in the interior of the tet are already in order; those on its boundary belong in
  // between.
  std::sort(runs.begin() + firstRun, runs.end(),
            [](const PlaceRun& a, const PlaceRun& b) { return a.first < b.first; });
}

void LatticePlaces::enterInIndex(Index tet, std::span<const PlaceRun> runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto run = static_cast<std::uint16_t>(std::min<std::size_t>(i, kUnknownRun));
    std::fill_n(runOf_.begin() + static_cast<std::ptrdiff_t>(begin_[tet] + runs[i].first),
                runs[i].count, run);
  }
}

void LatticePlaces::proveTet(Index tet, const sweep::VertexNumbers& numbers,
                             std::span<const lattice::SweptLine> lines,
                             sweep::BlockLists<PlaceRun>& runs, Faults& wrong) {
  collectRuns(tet, numbers, lines, runs.next());
  bool right = areInTet(map_, FaceSides(map_.exact.corners[tet], map_.exact.unit), lines, 0);
  Index next = 0;
  for (const PlaceRun& run : runs.last()) {
    right = right && run.first == next;
    next += run.count;
  }
  right = right && next == begin_[tet + 1] - begin_[tet];
  if (!right) wrong.add(tet);
  if (right && given_ == nullptr) enterInIndex(tet, runs.last());
}

void LatticePlaces::prove(Stage& stage, Faults& wrong) {
  assert(given_ == nullptr);  // or there were no lines
  runOf_.resize(count());
  runs_ = sweep::TetLists<PlaceRun>(map_.topology.tetCount());
  parallelBlocksWith(
      stage, map_.topology.tetCount(), sweep::kSweepBlock,
      [] { return sweep::BlockLists<PlaceRun>(true); },
      [&](std::size_t begin, std::size_t end, std::size_t block,
          sweep::BlockLists<PlaceRun>& runs) {
        runs.clear();
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          proveTet(tet, swept_.numbers, swept_.lines.of(tet), runs, wrong);
        }
        runs_.store(block, runs);
        runs.shrink();
      });
  swept_ = {sweep::TetLines(0), {}};
}

void LatticePlaces::proveOnly(std::span<const Index> tets, Stage& stage, Faults& wrong) {
  assert(given_ != nullptr && std::is_sorted(tets.begin(), tets.end()));
  runs_ = sweep::TetLists<PlaceRun>(map_.topology.tetCount());
  struct Working {
    sweep::BlockLists<PlaceRun> runs{true};
    std::vector<lattice::SweptLine> lines;
  };
  parallelBlocksWith(
      stage, map_.topology.tetCount(), sweep::kSweepBlock, [] { return Working(); },
      [&](std::size_t begin, std::size_t end, std::size_t block, Working& working) {
        auto next = std::lower_bound(tets.begin(), tets.end(), begin);
        working.runs.clear();
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          if (next == tets.end() || *next != tet) {
            static_cast<void>(working.runs.next());  // no runs
            continue;
          }
          ++next;
          working.lines.clear();
          lattice::TetRasterizer(map_.exact.corners[tet], map_.exact.unit)
              .append(lattice::kVertexGrid, working.lines);
          proveTet(tet, *given_, working.lines, working.runs, wrong);
        }
        runs_.store(block, working.runs);
      });
}

void LatticePlaces::compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage,
                            Faults& wrong) const {
  const std::uint64_t end = first + points.size();
  const auto [begin, endTet] = tetsWith(begin_, first, end);
  parallelFor(stage, endTet - begin, sweep::kSweepBlock, [&, begin = begin](std::size_t i) {
    const auto tet = static_cast<Index>(begin + i);
    if (begin_[tet] == begin_[tet + 1]) return;
    const SpaceOfTet space(map_, tet);
    for (const PlaceRun& run : runsOf(tet)) {
      const std::uint64_t number = begin_[tet] + run.first;
      const std::uint64_t low = std::max(number, first);
      const std::uint64_t high = std::min(number + run.count, end);
      if (low >= high) continue;
      lattice::GridPoint z = run.z;
      z[run.axis] += static_cast<std::int32_t>(low - number);
      space.compare(z, run.axis, points.subspan(low - first, high - low),
                    [&](std::size_t k) { wrong.add(low + k); });
    }
  });
}

void LatticePlaces::compare(std::span<const std::uint64_t> numbers, std::span<const Vec3> points,
                            Stage& stage, Faults& wrong) const {
  constexpr std::size_t kGrain = 4096;
  parallelBlocks(stage, numbers.size(), kGrain,
                 [&](std::size_t at, std::size_t end, std::size_t /*block*/) {
                   std::optional<SpaceOfTet> space;
                   Index tet = kNone;
                   while (at < end) {
                     const std::uint64_t first = numbers[at];
                     if (first >= count()) return wrong.add(first);
                     if (tet == kNone || !owns(tet, first)) {
                       tet = ownerOf(first);
                       space.emplace(map_, tet);
                     }
                     const PlaceRun& run = runWith(tet, first);
                     const std::uint64_t offset = first - begin_[tet] - run.first;
                     std::size_t behind = at + 1;
                     while (behind < end && behind - at < run.count - offset &&
                            numbers[behind] == first + (behind - at)) {
                       ++behind;
                     }
                     lattice::GridPoint z = run.z;
                     z[run.axis] += static_cast<std::int32_t>(offset);
                     space->compare(z, run.axis, points.subspan(at, behind - at),
                                    [&](std::size_t k) { wrong.add(first + k); });
                     at = behind;
                   }
                 });
}

Index LatticePlaces::ownerOf(std::uint64_t number) const {
  return static_cast<Index>(std::upper_bound(begin_.begin(), begin_.end(), number) -
                            begin_.begin() - 1);
}

const PlaceRun& LatticePlaces::runWith(Index owner, std::uint64_t number) const {
  assert(owns(owner, number));
  const std::span<const PlaceRun> runs = runsOf(owner);
  const std::uint16_t known = runOf_.empty() ? kUnknownRun : runOf_[number];
  if (known != kUnknownRun) return runs[known];
  const auto isBefore = [](Index value, const PlaceRun& run) { return value < run.first; };
  const auto offset = static_cast<Index>(number - begin_[owner]);
  return *(std::upper_bound(runs.begin(), runs.end(), offset, isBefore) - 1);
}

LatticePlace LatticePlaces::placeIn(Index owner, std::uint64_t number) const {
  const PlaceRun& run = runWith(owner, number);
  LatticePlace place{owner, run.z, run.simplex};
  place.z[run.axis] += static_cast<std::int32_t>(number - begin_[owner] - run.first);
  return place;
}

}  // namespace hexhex::verification
