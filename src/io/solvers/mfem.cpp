#include <base/parallel.hpp>
#include <io/core/output_file.hpp>
#include <io/solvers/mfem.hpp>

namespace hexhex {

MfemElements::MfemElements(const HexMesh& mesh, double patchAngle, Stage& stage, int threads)
    : mesh_(mesh) {
  withThreads(threads, [&] { quads_ = groupQuads(mesh, patchAngle, stage); });
  attributes_ = groupNumbers(quads_.groups);
  regions_ = cellReferences(mesh);
}

void MfemElements::write(OutputFile& output, LineWriter& lines, LoopProgress& progress) const {
  output.write("MFEM mesh v1.0\n\ndimension\n3\n\nelements\n");
  output.write(mesh_.cells.size()).write('\n');
  const auto cell = [this](char* place, std::size_t i) {
    place = put(put(place, regions_.empty() ? 1U : regions_[i]), " 5 ");  // 5: a cube
    return put(putNumbers(place, mesh_.cells[i]), '\n');
  };
  lines.write(mesh_.cells.size(), 10 * (kNumberRoom + 1), cell, &progress);
  output.write("\nboundary\n").write(quads_.elements.size()).write('\n');
  const auto quad = [this](char* place, std::size_t i) {
    place = put(put(place, attributes_[i]), " 3 ");  // 3: a square
    return put(putNumbers(place, quads_.elements[i]), '\n');
  };
  lines.write(quads_.elements.size(), 6 * (kNumberRoom + 1), quad, &progress);
}

void writeMfem(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const MfemElements elements(mesh, options.patchAngle, stage, context.threads());
  LineWriter lines(output, context.threads());
  LoopProgress progress(stage, elements.count() + mesh.points.size());
  elements.write(output, lines, progress);
  output.write("\nvertices\n").write(mesh.points.size()).write("\n3\n");
  const auto point = [&mesh](char* place, std::size_t i) {
    return put(putNumbers(place, mesh.points[i]), '\n');
  };
  lines.write(mesh.points.size(), 3 * (kNumberRoom + 1), point, &progress);
  output.commit();
}

}  // namespace hexhex
