#include "partial_text.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/core.h>

#include <hexhex/version.hpp>

#include "json.hpp"
#include "output.hpp"

namespace hexhex::command {
namespace {

constexpr std::size_t kMaxListed = 20;

std::uint64_t cellsAtHoles(const PartialMesh& partial) {
  const auto& regions = partial.mesh.regions;
  return static_cast<std::uint64_t>(std::count(regions.begin(), regions.end(), std::int32_t{1}));
}

void printHole(const Hole& hole) {
  printLine(fmt::format("hole at tet {}", hole.tet),
            fmt::format("about {:.2f} cells missing near ({:.4g}, {:.4g}, {:.4g}), in {}, {} of "
                        "them invalid",
                        hole.missingCells, hole.position[0], hole.position[1], hole.position[2],
                        counted(hole.tets, "tet"), hole.invalidTets));
}

}  // namespace

void printPartial(const PartialMesh& partial) {
  printLine("mesh", fmt::format("{}, {} of them at holes (region 1)",
                                counted(partial.mesh.cells.size(), "cell"), cellsAtHoles(partial)));
  printLine("missing", fmt::format("about {:.1f} cells, at {} with {}", partial.missingCells,
                                   counted(partial.holes.size(), "hole"),
                                   counted(partial.invalidTets, "invalid tet")));
  printLine("local verification",
            fmt::format("every cell is filled by valid tets; {} do not fit together",
                        counted(partial.faceConflicts, "face")));
  const std::size_t listed = std::min(partial.holes.size(), kMaxListed);
  for (std::size_t i = 0; i < listed; ++i) printHole(partial.holes[i]);
  if (partial.holes.size() > listed) {
    printLine("and", counted(partial.holes.size() - listed, "smaller hole"));
  }
}

std::string partialReportAsJson(const PartialMesh& partial, const Error& problem, int scale) {
  Json holes = Json::array();
  for (const Hole& hole : partial.holes) {
    holes.push_back({{"tet", hole.tet},
                     {"position", hole.position},
                     {"tets", hole.tets},
                     {"invalid_tets", hole.invalidTets},
                     {"missing_cells", hole.missingCells}});
  }
  const Json report = {{"hexhex_version", HEXHEX_VERSION},
                       {"partial", true},
                       {"error",
                        {{"code", name(problem.code())},
                         {"sentence", problem.what()},
                         {"place", toString(problem.place())}}},
                       {"scale", scale},
                       {"cells", partial.mesh.cells.size()},
                       {"vertices", partial.mesh.points.size()},
                       {"cells_at_holes", cellsAtHoles(partial)},
                       {"face_conflicts", partial.faceConflicts},
                       {"invalid_tets", partial.invalidTets},
                       {"missing_cells", partial.missingCells},
                       {"holes", std::move(holes)}};
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hexhex::command
