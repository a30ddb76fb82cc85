// The writing half of vtk_legacy.hpp.
#include <cstdint>
#include <span>
#include <string>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/core/writable.hpp>
#include <io/vtk/vtk_legacy.hpp>
#include <io/vtk/vtk_legacy_lines.hpp>

namespace hexhex {
namespace {

constexpr std::string_view kMeshTitle = "hexahedral mesh by hexhex";
constexpr std::string_view kMapTitle = "integer-grid map by hexhex";
constexpr std::uint32_t kTetType = 10;
constexpr std::uint32_t kHexahedronType = 12;

template <class Numbers>
void writeMesh(const HexMesh& mesh, const std::filesystem::path& file, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);
  requireVtkIndices<Numbers>(mesh.points.size(), file.string());
  LineWriter lines(output, context.threads());
  const std::size_t cells = mesh.cells.size();
  LoopProgress progress(stage, mesh.points.size() + 2 * cells);
  writeVtkHead<Numbers>(output, kMeshTitle, mesh.points.size());
  writeVtkReals<Numbers>(lines, std::span<const Vec3>(mesh.points), &progress);
  writeVtkCellsHead<Numbers>(output, cells, std::tuple_size_v<Hex>);
  writeVtkCells<Numbers>(lines, std::span<const Hex>(mesh.cells), &progress);
  writeVtkTypes<Numbers>(output, lines, cells, kHexahedronType, &progress);
  if (!mesh.regions.empty()) {
    output.write("CELL_DATA ").write(cells).write("\nSCALARS region int 1\nLOOKUP_TABLE default\n");
    const auto region = [&mesh](char* place, std::size_t i) {
      return Numbers::integer(place, mesh.regions[i]);
    };
    lines.write(cells, Numbers::kRoom, region, nullptr);
    output.write(Numbers::kEndOfSection);
  }
  output.commit();
}

/// Names of arrays are tokens: other characters are written as "%20", as VTK does it.
std::string encodedName(std::string_view name) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  if (name.empty()) {
    throw Error(ErrorCode::InvalidArgument, "The name of the map's array is empty.");
  }
  std::string token;
  for (const char c : name) {
    if (c > ' ' && c <= '~' && c != '%' && c != '"') {
      token += c;
      continue;
    }
    const auto code = static_cast<unsigned char>(c);
    token += {'%', kDigits[code / 16U], kDigits[code % 16U]};
  }
  return token;
}

template <class Numbers>
void writeMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  using Numbers12 = std::array<double, 12>;
  static_assert(sizeof(Numbers12) == sizeof(TetParameters));
  Stage stage(context, "write map");
  const std::string name = encodedName(options.mapArray);
  OutputFile output(file);
  withThreads(context.threads(), [&] { requireWritable(map, stage); });
  requireVtkIndices<Numbers>(map.points.size(), file.string());
  LineWriter lines(output, context.threads());
  const std::size_t tets = map.tets.size();
  LoopProgress progress(stage, map.points.size() + 3 * tets);
  writeVtkHead<Numbers>(output, kMapTitle, map.points.size());
  writeVtkReals<Numbers>(lines, std::span<const Vec3>(map.points), &progress);
  writeVtkCellsHead<Numbers>(output, tets, std::tuple_size_v<Tet>);
  writeVtkCells<Numbers>(lines, std::span<const Tet>(map.tets), &progress);
  writeVtkTypes<Numbers>(output, lines, tets, kTetType, &progress);
  output.write("CELL_DATA ").write(tets).write("\nFIELD FieldData 1\n").write(name);
  output.write(" 12 ").write(tets).write(" double\n");
  lines.write(
      tets, 12 * Numbers::kRoom,
      [&map](char* place, std::size_t t) {
        Numbers12 numbers;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
          numbers[i] = map.parameters[t][i / 3][i % 3];
        }
        return Numbers::reals(place, numbers);
      },
      &progress);
  output.write(Numbers::kEndOfSection);
  output.commit();
}

template <class Numbers>
class VtkLegacySink final : public CheckedSink {
 public:
  VtkLegacySink(const std::filesystem::path& file, Context& context)
      : CheckedSink(file.string(), "write mesh", context),
        name_(file.string()),
        output_(file),
        lines_(output_, threads()) {}

 private:
  void takeBegin() override {
    requireVtkIndices<Numbers>(pointCount(), name_);
    writeVtkHead<Numbers>(output_, kMeshTitle, pointCount());
  }
  void takePoints(const PointPiece& piece) override {
    writeVtkReals<Numbers>(lines_, piece.points);
  }
  void takeCellsBegin() override {
    writeVtkCellsHead<Numbers>(output_, cellCount(), std::tuple_size_v<Hex>);
  }
  void takeCells(std::uint64_t /*first*/, std::span<const Hex> cells) override {
    writeVtkCells<Numbers>(lines_, cells);
  }
  void takeCells(std::uint64_t /*first*/, std::span<const Hex64> cells) override {
    writeVtkCells<Numbers>(lines_, cells);
  }
  void takeEnd() override {
    writeVtkTypes<Numbers>(output_, lines_, cellCount(), kHexahedronType);
    output_.commit();
  }

  std::string name_;
  OutputFile output_;
  LineWriter lines_;
};

}  // namespace

void writeVtkLegacy(const HexMesh& mesh, const std::filesystem::path& file,
                    const WriteOptions& /*options*/, Context& context) {
  writeMesh<VtkText>(mesh, file, context);
}

void writeVtkLegacyBinary(const HexMesh& mesh, const std::filesystem::path& file,
                          const WriteOptions& /*options*/, Context& context) {
  writeMesh<VtkBytes>(mesh, file, context);
}

void writeVtkLegacyMap(const TetMap& map, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  writeMap<VtkText>(map, file, options, context);
}

void writeVtkLegacyMapBinary(const TetMap& map, const std::filesystem::path& file,
                             const WriteOptions& options, Context& context) {
  writeMap<VtkBytes>(map, file, options, context);
}

std::unique_ptr<MeshSink> openVtkLegacySink(const std::filesystem::path& file, Context& context) {
  return std::make_unique<VtkLegacySink<VtkText>>(file, context);
}

std::unique_ptr<MeshSink> openVtkLegacyBinarySink(const std::filesystem::path& file,
                                                  Context& context) {
  return std::make_unique<VtkLegacySink<VtkBytes>>(file, context);
}

}  // namespace hexhex
