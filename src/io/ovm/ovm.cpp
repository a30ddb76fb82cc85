#include <type_traits>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/ovm/ovm.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {
namespace {

using Parse = OvmMesh (*)(std::string_view bytes, const std::string& fileName, Stage& stage);
using Write = void (*)(const OvmOutput& mesh, OutputFile& output, Stage& stage);
template <class Result>
using Convert = Result (*)(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// @param source  the bytes of a file, or its path
template <class Result, class Source>
Result read(const Source& source, const std::string& fileName, Context& context,
            std::string_view stageName, Parse parseFile, Convert<Result> convert) {
  Stage stage(context, stageName);
  const auto parsed = [&] {
    if constexpr (std::is_same_v<Source, std::string_view>) {
      return parseFile(source, fileName, stage);
    } else {
      const Array<char> bytes = readWholeFile(source, stage);  // given back before cells are made
      return parseFile(asText(bytes), fileName, stage);
    }
  };
  Result result;
  withThreads(context.threads(), [&] { result = convert(parsed(), fileName, stage); });
  return result;
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

TetMap readOvmMap(const std::filesystem::path& file, Context& context) {
  return read<TetMap>(file, file.string(), context, "read map", parseOvmText, toTetMap);
}
TetMap readOvmbMap(const std::filesystem::path& file, Context& context) {
  return read<TetMap>(file, file.string(), context, "read map", parseOvmb, toTetMap);
}
TetCells readOvmTets(const std::filesystem::path& file, Context& context) {
  return read<TetCells>(file, file.string(), context, "read tets", parseOvmText, toTetCells);
}
TetCells readOvmbTets(const std::filesystem::path& file, Context& context) {
  return read<TetCells>(file, file.string(), context, "read tets", parseOvmb, toTetCells);
}
HexMesh readOvmHexMesh(const std::filesystem::path& file, Context& context) {
  return read<HexMesh>(file, file.string(), context, "read mesh", parseOvmText, toHexMesh);
}
HexMesh readOvmbHexMesh(const std::filesystem::path& file, Context& context) {
  return read<HexMesh>(file, file.string(), context, "read mesh", parseOvmb, toHexMesh);
}

TetMap parseOvmMap(std::string_view text, const std::string& fileName, Context& context) {
  return read<TetMap>(text, fileName, context, "read map", parseOvmText, toTetMap);
}
TetMap parseOvmbMap(std::string_view bytes, const std::string& fileName, Context& context) {
  return read<TetMap>(bytes, fileName, context, "read map", parseOvmb, toTetMap);
}
HexMesh parseOvmHexMesh(std::string_view text, const std::string& fileName, Context& context) {
  return read<HexMesh>(text, fileName, context, "read mesh", parseOvmText, toHexMesh);
}
HexMesh parseOvmbHexMesh(std::string_view bytes, const std::string& fileName, Context& context) {
  return read<HexMesh>(bytes, fileName, context, "read mesh", parseOvmb, toHexMesh);
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

}  // namespace hexhex
