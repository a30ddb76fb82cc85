#include <algorithm>
#include <optional>

#include <parts/part_positions.hpp>

#include <base/workspaces.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex::parts {

namespace {

/// The wanted vertices of one tet.
struct OwnersVertices {
  Index tet;
  std::size_t begin;  ///< in the numbers
  std::size_t end;
};

std::vector<OwnersVertices> groupByOwner(const sweep::ElementCounts& counts,
                                         std::span<const std::uint64_t> numbers) {
  const Array<std::uint64_t>& begin = counts.vertices.begin;
  std::vector<OwnersVertices> groups;
  for (std::size_t i = 0; i < numbers.size();) {
    const auto behind = std::upper_bound(begin.begin(), begin.end(), numbers[i]);
    std::size_t end = i;
    while (end < numbers.size() && numbers[end] < *behind) ++end;
    groups.push_back({static_cast<Index>(behind - begin.begin() - 1), i, end});
    i = end;
  }
  return groups;
}

class Describer {
 public:
  Describer(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
            std::span<const std::uint64_t> numbers, std::size_t first, HexMesh& mesh)
      : map_(map), counts_(counts), numbers_(numbers), first_(first), mesh_(mesh) {}

  void describe(const OwnersVertices& wanted) {
    lines_.clear();
    lattice::TetRasterizer(map_.exact.corners[wanted.tet], map_.exact.unit)
        .append(lattice::kVertexGrid, lines_);
    const lattice::SweepAxes axes = lines_.front().axes;
    const sweep::TetPositions positions(map_, wanted.tet, axes);
    sweep::TetNumbering(map_, counts_.vertices, wanted.tet, axes)
        .run(lines_, [&](const sweep::VertexRun& run) {
          if (run.owned) describe(run, wanted, positions);
        });
  }

 private:
  void describe(const sweep::VertexRun& run, const OwnersVertices& wanted,
                const sweep::TetPositions& positions) {
    const auto last = numbers_.begin() + static_cast<std::ptrdiff_t>(wanted.end);
    // Interior vertices are numbered in the order of the sweep, so that the next is soon found.
    auto next = std::lower_bound(numbers_.begin() + static_cast<std::ptrdiff_t>(wanted.begin), last,
                                 run.first);
    for (; next != last && *next < run.first + run.count; ++next) {
      const auto i = static_cast<std::uint32_t>(*next - run.first);
      const std::size_t at = first_ + static_cast<std::size_t>(next - numbers_.begin());
      const lattice::SweptLine& line = *run.line;
      if (run.simplex == lattice::kWholeTet) {
        positions.alongLine(line.level, line.row,
                            line.first + static_cast<std::int32_t>(run.offset + i), 1,
                            &mesh_.points[at]);
      } else {
        mesh_.points[at] = positions.at(run.simplex, line.point(run.offset + i));
      }
      mesh_.generatorTet[at] = wanted.tet;
      mesh_.generatorCorners[at] = map_.input.callersCorners(run.simplex);
    }
  }

  const igm::PreparedMap& map_;
  const sweep::ElementCounts& counts_;
  std::span<const std::uint64_t> numbers_;
  std::size_t first_;
  HexMesh& mesh_;
  std::vector<lattice::SweptLine> lines_;
};

}  // namespace

void describeVertices(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
                      std::span<const std::uint64_t> numbers, std::size_t first, HexMesh& mesh,
                      Stage& stage) {
  const std::vector<OwnersVertices> groups = groupByOwner(counts, numbers);
  constexpr std::size_t kFewGroups = 8;
  parallelForWith(
      stage, groups.size(), kFewGroups,
      [&] { return Describer(map, counts, numbers, first, mesh); },
      [&](std::size_t i, Describer& describer) { describer.describe(groups[i]); });
}

}  // namespace hexhex::parts
