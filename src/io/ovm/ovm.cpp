#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/ovm/ovm.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex::io {
namespace {

using Parse = OvmMesh (*)(std::string_view bytes, const std::string& fileName, Stage& stage);
using Write = void (*)(const OvmOutput& mesh, OutputFile& output, Stage& stage);
template <class Result>
using Convert = Result (*)(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

template <class Result>
Result read(const Input& input, Context& context, std::string_view stageName, Parse parse,
            Convert<Result> convert) {
  return inStage(context, stageName, [&](Stage& stage) {
    const auto parsed = [&] {
      Array<char> room;  // given back before cells are made
      // "OVM ASCII" or "Vertices" in any case, a comment, or "OVMB".
      return parse(input.text(room, stage, "OoVv#"), input.name(), stage);
    };
    return convert(parsed(), input.name(), stage);
  });
}

/// @param mesh  a map or a hex mesh
template <class Mesh>
void write(const Mesh& mesh, const std::filesystem::path& file, Context& context,
           std::string_view stageName, Write writeFile) {
  Stage stage(context, stageName);
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  withThreads(context.threads(), [&] { writeFile(toOvm(mesh, stage), output, stage); });
}

}  // namespace

TetMap readOvmMap(const Input& input, Context& context) {
  return read<TetMap>(input, context, "read map", parseOvmText, toTetMap);
}
TetMap readOvmbMap(const Input& input, Context& context) {
  return read<TetMap>(input, context, "read map", parseOvmb, toTetMap);
}
TetCells readOvmTets(const Input& input, Context& context) {
  return read<TetCells>(input, context, "read tets", parseOvmText, toTetCells);
}
TetCells readOvmbTets(const Input& input, Context& context) {
  return read<TetCells>(input, context, "read tets", parseOvmb, toTetCells);
}
HexMesh readOvmHexMesh(const Input& input, Context& context) {
  return read<HexMesh>(input, context, "read mesh", parseOvmText, toHexMesh);
}
HexMesh readOvmbHexMesh(const Input& input, Context& context) {
  return read<HexMesh>(input, context, "read mesh", parseOvmb, toHexMesh);
}

void writeOvmMap(const TetMap& map, const std::filesystem::path& file, Context& context) {
  write(map, file, context, "write map", writeOvmText);
}
void writeOvmbMap(const TetMap& map, const std::filesystem::path& file, Context& context) {
  write(map, file, context, "write map", writeOvmb);
}
void writeOvmHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& /*options*/, Context& context) {
  write(mesh, file, context, "write mesh", writeOvmText);
}
void writeOvmbHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                      const WriteOptions& /*options*/, Context& context) {
  write(mesh, file, context, "write mesh", writeOvmb);
}

}  // namespace hexhex::io
