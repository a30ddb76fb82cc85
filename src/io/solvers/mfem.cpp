// MFEM mesh v1.0, of straight cells and of Lagrange cells.
#include <cstdint>
#include <optional>

#include <hexhex/curved.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex::io {
namespace {

/// Writes one file front to back.
class MfemWriter {
 public:
  MfemWriter(const std::filesystem::path& file, int threads)
      : output_(file), lines_(output_, threads), threads_(threads) {}

  /// What all files begin with: cells and quads by their vertices, with attributes.
  /// @param more  lines that follow
  void writeElements(const HexMesh& mesh, double patchAngle, std::size_t more, Stage& stage) {
    QuadGroups quads;
    withThreads(threads_, [&] { quads = groupQuads(mesh, patchAngle, stage); });
    const Array<std::uint32_t> attributes = groupNumbers(quads.groups);
    const Array<std::uint32_t> regions = cellReferences(mesh);  // empty: all are 1
    progress_.emplace(stage, mesh.cells.size() + quads.elements.size() + more);
    output_.write("MFEM mesh v1.0\n\ndimension\n3\n\nelements\n");
    output_.write(mesh.cells.size()).write('\n');
    const auto cell = [&](char* place, std::size_t i) {
      place = put(put(place, regions.empty() ? 1U : regions[i]), " 5 ");  // 5: a cube
      return put(putNumbers(place, mesh.cells[i]), '\n');
    };
    lines_.write(mesh.cells.size(), 10 * (kNumberRoom + 1), cell, &*progress_);
    output_.write("\nboundary\n").write(quads.elements.size()).write('\n');
    const auto quad = [&](char* place, std::size_t i) {
      place = put(put(place, attributes[i]), " 3 ");  // 3: a square
      return put(putNumbers(place, quads.elements[i]), '\n');
    };
    lines_.write(quads.elements.size(), 6 * (kNumberRoom + 1), quad, &*progress_);
  }

  [[nodiscard]] OutputFile& output() noexcept { return output_; }

  /// @param pointAt  of n points
  template <class F>
  void writePoints(std::size_t n, const F& pointAt) {
    const auto point = [&](char* place, std::size_t i) {
      return put(putNumbers(place, pointAt(i)), '\n');
    };
    lines_.write(n, 3 * (kNumberRoom + 1), point, &*progress_);
    output_.commit();
  }

 private:
  OutputFile output_;
  LineWriter lines_;
  int threads_;
  std::optional<LoopProgress> progress_;
};

}  // namespace

void writeMfem(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context) {
  Stage stage(context, "write mesh");
  MfemWriter writer(file, context.threads());
  writer.writeElements(mesh, options.patchAngle, mesh.points.size(), stage);
  writer.output().write("\nvertices\n").write(mesh.points.size()).write("\n3\n");
  writer.writePoints(mesh.points.size(),
                     [&](std::size_t i) -> const Vec3& { return mesh.points[i]; });
}

void writeLagrangeMfem(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  MfemWriter writer(file, context.threads());
  const HexMesh straight = straightMesh(mesh);
  writer.writeElements(straight, options.patchAngle, mesh.nodes.size(), stage);
  // L2_T4: polynomials on each cell, given by their values at equidistant nodes, x first: the order
  // of LagrangeMesh. Ordering 1: all coordinates of one node together.
  OutputFile& output = writer.output();
  output.write("\nvertices\n").write(straight.points.size());
  output.write("\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T4_3D_P");
  output.write(static_cast<unsigned>(mesh.order)).write("\nVDim: 3\nOrdering: 1\n\n");
  writer.writePoints(mesh.nodes.size(),
                     [&](std::size_t i) -> const Vec3& { return mesh.points[mesh.nodes[i]]; });
}

}  // namespace hexhex::io
