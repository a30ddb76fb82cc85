// How often improve() makes all cells of a mesh positive: meshes of real maps at many scales.
//
//   hexhex_improve_trials MOST_CELLS MAP.hexex...
#include <cstdio>
#include <filesystem>
#include <string>

#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>

using namespace hexhex;

namespace {

struct Count {
  int bad = 0;
  int mended = 0;
};

void print(const std::string& name, int scale, std::size_t cells, const ImproveReport& report) {
  std::printf(
      "%-28s x%-3d %8zu %5zu -> %4zu  min %6.3f -> %6.3f mean %.4f -> %.4f H %.1e -> %.1e (%.1e "
      "%.1e) moved %.1e off %zu %6.2f s%s\n",
      name.c_str(), scale, cells, static_cast<std::size_t>(report.before.refuted),
      static_cast<std::size_t>(report.after.refuted + report.after.undecided),
      report.before.quality.minimum, report.after.quality.minimum, report.before.quality.mean,
      report.after.quality.mean, report.distanceBefore.hausdorff(),
      report.distanceAfter.hausdorff(), report.distanceAfter.fromMesh,
      report.distanceAfter.fromSurface, report.largestMove,
      static_cast<std::size_t>(report.offSurface), report.seconds,
      report.after.allPositive() ? "" : " <<<");
  std::fflush(stdout);
}

void tryMap(const std::filesystem::path& file, double most, Count& count) {
  Context context(1);
  const TetMap map = readMap(file, {}, context);
  for (int scale = 1; scale < 300; scale = scale < 4 ? scale + 1 : scale * 3 / 2) {
    ExtractOptions options;
    options.scale = scale;
    HexMesh mesh = extract(map, options, context);
    if (static_cast<double>(mesh.cells.size()) > most) break;
    const ImproveReport report = improve(mesh, map, {}, context);
    print(file.stem().string(), scale, mesh.cells.size(), report);
    if (report.before.allPositive()) continue;
    ++count.bad;
    if (report.after.allPositive()) ++count.mended;
  }
}

}  // namespace

int main(int argc, char** argv) {
  Count count;
  for (int f = 2; f < argc; ++f) tryMap(argv[f], std::stod(argv[1]), count);
  std::printf("%d of %d mended\n", count.mended, count.bad);
}
