#include <algorithm>

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

void LatticePlaces::prove(bool listed, Stage& stage, Faults& wrong) {
  if (listed) places_.resize(count());
  parallelForWith(
      stage, map_.topology.tetCount(), kSweepBlock, [] { return std::vector<char>(); },
      [&](std::size_t tet, std::vector<char>& seen) {
        if (!isProven(static_cast<Index>(tet), seen)) wrong.add(tet);
      });
}

bool LatticePlaces::isProven(Index tet, std::vector<char>& seen) {
  const std::uint64_t first = swept_.numbers.begin[tet];
  std::uint64_t left = swept_.numbers.begin[tet + 1] - first;
  const std::span<const SweptLine> lines = swept_.lines.of(tet);
  if (lines.empty()) return left == 0;
  seen.assign(left, 0);
  bool right = areInTet(map_, FaceSides(map_.exact.corners[tet], map_.exact.unit), lines, 0);
  forEachRun(tet, [&](const VertexRun& run) {
    right = right && run.count <= left && run.first >= first &&
            run.first - first + run.count <= seen.size();
    if (!right) return;
    left -= run.count;
    char* const begin = &seen[run.first - first];
    right = std::find(begin, begin + run.count, 1) == begin + run.count;
    std::fill_n(begin, run.count, 1);
    if (!places_.empty()) list(tet, run);
  });
  return right && left == 0;
}

void LatticePlaces::list(Index tet, const VertexRun& run) {
  GridPoint z = run.line->point(run.offset);
  for (std::uint64_t v = run.first; v < run.first + run.count; ++v) {
    places_[v] = {tet, z, run.simplex};
    ++z[run.line->axes()[2]];
  }
}

void LatticePlaces::compare(std::uint64_t first, std::span<const Vec3> points, Stage& stage,
                            Faults& wrong) const {
  const std::uint64_t end = first + points.size();
  const auto [begin, endTet] = tetsWith(swept_.numbers.begin, first, end);
  parallelFor(stage, endTet - begin, kSweepBlock, [&, begin = begin](std::size_t i) {
    const auto tet = static_cast<Index>(begin + i);
    if (swept_.numbers.begin[tet] == swept_.numbers.begin[tet + 1]) return;
    const SpaceOfTet space(map_, tet);
    forEachRun(tet, [&](const VertexRun& run) {
      const std::uint64_t low = std::max(run.first, first);
      const std::uint64_t high = std::min(run.first + run.count, end);
      if (low >= high) return;
      space.compare(run.line->point(run.offset + static_cast<std::uint32_t>(low - run.first)),
                    run.line->axes()[2], points.subspan(low - first, high - low),
                    [&](std::size_t k) { wrong.add(low + k); });
    });
  });
}

PlaceFinder::Found PlaceFinder::search(std::uint64_t point, Index likely) {
  const Array<std::uint64_t>& begin = places_.swept_.numbers.begin;
  Index tet = likely;
  if (point < begin[tet] || begin[tet + 1] <= point) {
    tet =
        static_cast<Index>(std::upper_bound(begin.begin(), begin.end(), point) - begin.begin() - 1);
  }
  TetRuns& of = tets_[tet % kTets];
  if (of.tet != tet) {
    of.tet = tet;
    of.runs.clear();
    places_.forEachRun(tet, [&of](const VertexRun& run) { of.runs.push_back(run); });
    std::sort(of.runs.begin(), of.runs.end(),
              [](const VertexRun& a, const VertexRun& b) { return a.first < b.first; });
  }
  const auto behind =
      std::upper_bound(of.runs.begin(), of.runs.end(), point,
                       [](std::uint64_t value, const VertexRun& run) { return value < run.first; });
  return {tet, *(behind - 1)};
}

}  // namespace hexhex
