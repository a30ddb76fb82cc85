#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/ovm/ovm.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_output.hpp>
#include <io/ovm/ovm_text.hpp>
#include <io/ovm/ovmb_chunks.hpp>
#include <io/ovm/ovmb_elements.hpp>
#include <io/ovm/ovmb_properties.hpp>

namespace hexhex {
namespace {

OvmMesh parseOvmb(std::string_view bytes, const std::string& fileName, Stage& stage) {
  const OvmbFrame frame = splitOvmb(bytes, fileName);
  OvmMesh mesh;
  readOvmbElements(frame, mesh, stage);
  readOvmbProperties(frame, mesh, stage);
  return mesh;
}

using Parse = OvmMesh (*)(std::string_view bytes, const std::string& fileName, Stage& stage);

template <class Result>
using Convert = Result (*)(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

template <class Result>
Result parse(std::string_view bytes, const std::string& fileName, Stage& stage, Parse parseFile,
             Convert<Result> convert) {
  Result result;
  withThreads(stage.context().threads(),
              [&] { result = convert(parseFile(bytes, fileName, stage), fileName, stage); });
  return result;
}

template <class Result>
Result read(const std::filesystem::path& file, Stage& stage, Parse parseFile,
            Convert<Result> convert) {
  Result result;
  withThreads(stage.context().threads(), [&] {
    const std::string fileName = file.string();
    const auto parsed = [&] {
      const Array<char> bytes = readWholeFile(file, stage);  // given back before cells are made
      return parseFile(asText(bytes), fileName, stage);
    };
    result = convert(parsed(), fileName, stage);
  });
  return result;
}

TetMap mapFrom(std::string_view bytes, const std::string& fileName, Context& context,
               Parse parseFile) {
  Stage stage(context, "read map");
  return parse<TetMap>(bytes, fileName, stage, parseFile, toTetMap);
}

HexMesh meshFrom(std::string_view bytes, const std::string& fileName, Context& context,
                 Parse parseFile) {
  Stage stage(context, "read mesh");
  return parse<HexMesh>(bytes, fileName, stage, parseFile, toHexMesh);
}

TetMap readMapWith(const std::filesystem::path& file, Context& context, Parse parseFile) {
  Stage stage(context, "read map");
  return read<TetMap>(file, stage, parseFile, toTetMap);
}

TetCells readTetsWith(const std::filesystem::path& file, Context& context, Parse parseFile) {
  Stage stage(context, "read tets");
  return read<TetCells>(file, stage, parseFile, toTetCells);
}

HexMesh readMeshWith(const std::filesystem::path& file, Context& context, Parse parseFile) {
  Stage stage(context, "read mesh");
  return read<HexMesh>(file, stage, parseFile, toHexMesh);
}

using Write = void (*)(const OvmOutput& mesh, OutputFile& output, Stage& stage);

void writeMapWith(const TetMap& map, const std::filesystem::path& file, Context& context,
                  Write write) {
  Stage stage(context, "write map");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  withThreads(context.threads(), [&] { write(toOvm(map, stage), output, stage); });
}

void writeMeshWith(const HexMesh& mesh, const TetMap* map, const std::filesystem::path& file,
                   Context& context, Write write) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, as above
  withThreads(context.threads(), [&] { write(toOvm(mesh, map, stage), output, stage); });
}

}  // namespace

TetMap readOvmMap(const std::filesystem::path& file, Context& context) {
  return readMapWith(file, context, parseOvmText);
}
TetMap readOvmbMap(const std::filesystem::path& file, Context& context) {
  return readMapWith(file, context, parseOvmb);
}
TetCells readOvmTets(const std::filesystem::path& file, Context& context) {
  return readTetsWith(file, context, parseOvmText);
}
TetCells readOvmbTets(const std::filesystem::path& file, Context& context) {
  return readTetsWith(file, context, parseOvmb);
}
HexMesh readOvmHexMesh(const std::filesystem::path& file, Context& context) {
  return readMeshWith(file, context, parseOvmText);
}
HexMesh readOvmbHexMesh(const std::filesystem::path& file, Context& context) {
  return readMeshWith(file, context, parseOvmb);
}

TetMap parseOvmMap(std::string_view text, const std::string& fileName, Context& context) {
  return mapFrom(text, fileName, context, parseOvmText);
}
TetMap parseOvmbMap(std::string_view bytes, const std::string& fileName, Context& context) {
  return mapFrom(bytes, fileName, context, parseOvmb);
}
HexMesh parseOvmHexMesh(std::string_view text, const std::string& fileName, Context& context) {
  return meshFrom(text, fileName, context, parseOvmText);
}
HexMesh parseOvmbHexMesh(std::string_view bytes, const std::string& fileName, Context& context) {
  return meshFrom(bytes, fileName, context, parseOvmb);
}

void writeOvmMap(const TetMap& map, const std::filesystem::path& file, Context& context) {
  writeMapWith(map, file, context, writeOvmTextFile);
}
void writeOvmbMap(const TetMap& map, const std::filesystem::path& file, Context& context) {
  writeMapWith(map, file, context, writeOvmbFile);
}

void writeOvmHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& /*options*/, Context& context) {
  writeMeshWith(mesh, nullptr, file, context, writeOvmTextFile);
}
void writeOvmbHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                      const WriteOptions& /*options*/, Context& context) {
  writeMeshWith(mesh, nullptr, file, context, writeOvmbFile);
}
void writeOvmHexMesh(const HexMesh& mesh, const TetMap& map, const std::filesystem::path& file,
                     Context& context) {
  writeMeshWith(mesh, &map, file, context, writeOvmTextFile);
}
void writeOvmbHexMesh(const HexMesh& mesh, const TetMap& map, const std::filesystem::path& file,
                      Context& context) {
  writeMeshWith(mesh, &map, file, context, writeOvmbFile);
}

}  // namespace hexhex
