// Exodus II: what all files of it have is in exodus_file.hpp.
#include <io/core/output_file.hpp>
#include <io/solvers/exodus_file.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex::io {

void writeExodus(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context, std::uint64_t mostBytes) {
  Stage stage(context, "write mesh");
  // First, so that a folder that is not writable shows at once.
  OutputFile target(file);
  requireInt32(mesh.points.size(), "An Exodus file numbers vertices");
  requireInt32(mesh.cells.size(), "An Exodus file numbers cells");
  const MeshGroups groups(mesh, options.patchAngle, stage);
  ExodusFile(mesh, groups, stage).write(target, context.threads(), mostBytes);
  target.commit();
}

}  // namespace hexhex::io
