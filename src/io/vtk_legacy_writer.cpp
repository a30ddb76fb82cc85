// The writing half of vtk_legacy.hpp.
#include <cstdint>

#include <base/stage.hpp>
#include <io/line_writer.hpp>
#include <io/output_file.hpp>
#include <io/vtk_legacy.hpp>

namespace hexhex {

void writeVtkLegacy(const HexMesh& mesh, const std::filesystem::path& file,
                    const WriteOptions& /*options*/, Context& context) {
  constexpr std::uint64_t kNumbersPerCell = 9;  // the number of corners, and the corners
  Stage stage(context, "write mesh");
  OutputFile output(file);
  LineWriter lines(output, context.threads());
  const std::size_t cells = mesh.cells.size();
  LoopProgress progress(stage, mesh.points.size() + 2 * cells);
  output.write("# vtk DataFile Version 2.0\nhexahedral mesh by hexhex\nASCII\n");
  output.write("DATASET UNSTRUCTURED_GRID\nPOINTS ").write(mesh.points.size()).write(" double\n");
  const auto point = [&mesh](char* place, std::size_t i) {
    return put(putNumbers(place, mesh.points[i]), '\n');
  };
  lines.write(mesh.points.size(), 3 * (kNumberRoom + 1), point, &progress);
  output.write("CELLS ").write(cells).write(' ').write(kNumbersPerCell * cells).write('\n');
  const auto cell = [&mesh](char* place, std::size_t i) {
    return put(putNumbers(put(place, "8 "), mesh.cells[i]), '\n');
  };
  lines.write(cells, kNumbersPerCell * (kNumberRoom + 1), cell, &progress);
  output.write("CELL_TYPES ").write(cells).write('\n');
  const auto type = [](char* place, std::size_t /*i*/) { return put(place, "12\n"); };
  lines.write(cells, 3, type, &progress);
  if (!mesh.regions.empty()) {
    output.write("CELL_DATA ").write(cells).write("\nSCALARS region int 1\nLOOKUP_TABLE default\n");
    const auto region = [&mesh](char* place, std::size_t i) {
      return put(put(place, mesh.regions[i]), '\n');
    };
    lines.write(cells, kNumberRoom + 1, region, nullptr);
  }
  output.commit();
}

}  // namespace hexhex
