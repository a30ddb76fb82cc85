// How often improve() makes all cells of a mesh positive: meshes of real maps at many scales.
//
//   hexhex_improve_trials ORDER MOST_CELLS MAP.hexex...
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>

using namespace hexhex;

namespace {

/// Meshes.
struct Count {
  int all = 0;
  int bad = 0;
  int untangled = 0;
  int cellsLost = 0;  ///< whose certificate went
  int lower = 0;      ///< with a lower minimum
  int offSurface = 0;
  int farther = 0;  ///< than before, and than 1e-3
  double seconds = 0;
};

void add(const ImproveReport& report, Count& count) {
  ++count.all;
  count.seconds += report.seconds;
  for (std::size_t c = 0; c < report.before.validity.size(); ++c) {
    count.cellsLost += static_cast<int>(report.before.validity[c] == Validity::Positive &&
                                        report.after.validity[c] != Validity::Positive);
  }
  count.lower += static_cast<int>(report.after.quality.minimum < report.before.quality.minimum);
  count.offSurface += static_cast<int>(report.offSurface > 0);
  const double before = std::max(report.distanceBefore.hausdorff(), kSurfaceTolerance);
  count.farther += static_cast<int>(report.distanceAfter.hausdorff() > 1.00001 * before);
  if (report.before.allPositive()) return;
  ++count.bad;
  if (report.after.allPositive()) ++count.untangled;
}

void print(const std::string& name, int scale, const ImproveReport& report) {
  std::printf(
      "%-28s x%-3d %8zu %5zu -> %4zu  min %6.3f -> %6.3f mean %.4f -> %.4f H %.1e -> %.1e (%.1e "
      "%.1e) moved %.1e off %zu %6.2f s%s\n",
      name.c_str(), scale, report.before.validity.size(),
      static_cast<std::size_t>(report.before.refuted + report.before.undecided),
      static_cast<std::size_t>(report.after.refuted + report.after.undecided),
      report.before.quality.minimum, report.after.quality.minimum, report.before.quality.mean,
      report.after.quality.mean, report.distanceBefore.hausdorff(),
      report.distanceAfter.hausdorff(), report.distanceAfter.fromMesh,
      report.distanceAfter.fromSurface, report.largestMove,
      static_cast<std::size_t>(report.offSurface), report.seconds,
      report.after.allPositive() ? "" : " <<<");
  std::fflush(stdout);
}

void tryMap(const std::filesystem::path& file, int order, double most, Count& count) {
  Context context(1);
  const TetMap map = readMap(file, {}, context);
  for (int scale = 1; scale < 300; scale = scale < 4 ? scale + 1 : scale * 3 / 2) {
    ExtractOptions options;
    options.scale = scale;
    HexMesh straight = extract(map, options, context);
    if (static_cast<double>(straight.cells.size()) > most) break;
    ImproveReport report;
    if (order == 1) {
      report = improve(straight, map, {}, context);
    } else {
      options.curvedNodes = CurvedNodes::Exact;  // which leaves something to improve
      LagrangeMesh mesh = extractLagrange(map, order, options, context);
      report = improve(mesh, map, {}, context);
    }
    print(file.stem().string(), scale, report);
    add(report, count);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Count count;
  for (int f = 3; f < argc; ++f) tryMap(argv[f], std::stoi(argv[1]), std::stod(argv[2]), count);
  std::printf(
      "%d meshes; %d of %d untangled; %d with a lower minimum, %d cells without their certificate, "
      "%d with vertices off the surface, %d farther from it; %.1f s\n",
      count.all, count.untangled, count.bad, count.lower, count.cellsLost, count.offSurface,
      count.farther, count.seconds);
}
