#include <algorithm>
#include <cstddef>

#include <verify/lattice_places.hpp>
#include <verify/space_of_tet.hpp>

#include <base/workspaces.hpp>

namespace hexhex {

bool areInTet(const PreparedMap& map, const FaceSides& sides, std::span<const SweptLine> lines,
              std::int64_t shift) {
  const auto simplexOf = [&](const SweptLine& line, std::uint32_t i) {
    const GridPoint z = line.point(i);
    LatticePoint point;
    for (std::size_t k = 0; k < 3; ++k) point[k] = z[k] * map.exact.unit + shift;
    return sides.simplexOf(point);
  };
  const SweptLine* before = nullptr;
  for (const SweptLine& line : lines) {
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

LatticePlaces::LatticePlaces(const PreparedMap& map, bool indexed, Stage& stage)
    : map_(map),
      indexed_(indexed),
      swept_(sweepVertices(map, stage)),
      begin_(swept_.numbers.begin),
      runs_(0) {}

void LatticePlaces::collectRuns(Index tet, std::vector<PlaceRun>& runs) const {
  const std::span<const SweptLine> lines = swept_.lines.of(tet);
  if (lines.empty()) return;
  const auto firstRun = static_cast<std::ptrdiff_t>(runs.size());
  TetNumbering(map_, swept_.numbers, tet, lines.front().axes).run(lines, [&](const VertexRun& run) {
    if (!run.owned) return;
    runs.push_back({static_cast<Index>(run.first - begin_[tet]), run.count,
                    run.line->point(run.offset), run.simplex, run.line->axes()[2]});
  });
  // Points in the interior of the tet are in order, those on its boundary come in between.
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

void LatticePlaces::prove(Stage& stage, Faults& wrong) {
  if (indexed_) runOf_.resize(count());
  runs_ = TetLists<PlaceRun>(map_.topology.tetCount());
  parallelBlocksWith(
      stage, map_.topology.tetCount(), kSweepBlock, [] { return BlockLists<PlaceRun>(true); },
      [&](std::size_t begin, std::size_t end, std::size_t block, BlockLists<PlaceRun>& runs) {
        runs.clear();
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          collectRuns(tet, runs.next());
          bool right = areInTet(map_, FaceSides(map_.exact.corners[tet], map_.exact.unit),
                                swept_.lines.of(tet), 0);
          Index next = 0;
          for (const PlaceRun& run : runs.last()) {
            right = right && run.first == next;
            next += run.count;
          }
          right = right && next == begin_[tet + 1] - begin_[tet];
          if (!right) wrong.add(tet);
          if (right && indexed_) enterInIndex(tet, runs.last());
        }
        runs_.store(block, runs);
        runs.shrink();
      });
  swept_ = {TetLines(0), {}};
}

void LatticePlaces::compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage,
                            Faults& wrong) const {
  const std::uint64_t end = first + points.size();
  const auto [begin, endTet] = tetsWith(begin_, first, end);
  parallelFor(stage, endTet - begin, kSweepBlock, [&, begin = begin](std::size_t i) {
    const auto tet = static_cast<Index>(begin + i);
    if (begin_[tet] == begin_[tet + 1]) return;
    const SpaceOfTet space(map_, tet);
    for (const PlaceRun& run : runsOf(tet)) {
      const std::uint64_t number = begin_[tet] + run.first;
      const std::uint64_t low = std::max(number, first);
      const std::uint64_t high = std::min(number + run.count, end);
      if (low >= high) continue;
      GridPoint z = run.z;
      z[run.axis] += static_cast<std::int32_t>(low - number);
      space.compare(z, run.axis, points.subspan(low - first, high - low),
                    [&](std::size_t k) { wrong.add(low + k); });
    }
  });
}

Index LatticePlaces::ownerOf(std::uint64_t number) const {
  return static_cast<Index>(std::upper_bound(begin_.begin(), begin_.end(), number) -
                            begin_.begin() - 1);
}

LatticePlace LatticePlaces::placeIn(Index owner, std::uint64_t number) const {
  const auto offset = static_cast<Index>(number - begin_[owner]);
  const std::span<const PlaceRun> runs = runsOf(owner);
  const auto search = [&] {
    const auto isBefore = [](Index value, const PlaceRun& run) { return value < run.first; };
    return std::upper_bound(runs.begin(), runs.end(), offset, isBefore) - runs.begin() - 1;
  };
  const std::uint16_t known = indexed_ ? runOf_[number] : kUnknownRun;
  const PlaceRun& run = runs[known != kUnknownRun ? known : static_cast<std::size_t>(search())];
  LatticePlace place{owner, run.z, run.simplex};
  place.z[run.axis] += static_cast<std::int32_t>(offset - run.first);
  return place;
}

}  // namespace hexhex
