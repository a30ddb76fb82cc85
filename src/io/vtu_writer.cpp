// The writing half of vtu.hpp. Arrays are described first, in a table; the XML head and the data
// behind it both follow from that table, so they cannot disagree.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <hexhex/quality.hpp>

#include <base/stage.hpp>
#include <io/output_file.hpp>
#include <io/vtu.hpp>

namespace hexhex {
namespace {

constexpr std::uint8_t kVtkHexahedron = 12;
constexpr std::size_t kCornersPerCell = 8;

// What is written between two looks at the caller's wish to cancel: some milliseconds' work.
constexpr std::size_t kSliceBytes = std::size_t{1} << 22;

/// One array of the file.
struct DataArray {
  std::string type;  ///< VTK's name of the number type
  std::string name;
  std::size_t components = 1;
  std::uint64_t bytes = 0;
  std::function<void(OutputFile&, LoopProgress&)> write;
};

/// One of the four parts of a piece, e.g. "PointData".
struct Section {
  std::string name;
  std::vector<DataArray> arrays;
};

/// An array that lies in memory exactly as it goes into the file.
template <class T>
DataArray fromMemory(std::string type, std::string name, std::size_t components,
                     const Array<T>& values) {
  const auto* const data = reinterpret_cast<const char*>(values.data());
  const std::size_t bytes = values.size() * sizeof(T);
  return {std::move(type), std::move(name), components, bytes,
          [data, bytes](OutputFile& output, LoopProgress& progress) {
            for (std::size_t begin = 0; begin < bytes; begin += kSliceBytes) {
              const std::size_t size = std::min(kSliceBytes, bytes - begin);
              output.writeBytes(data + begin, size);
              progress.advance(size);
            }
          }};
}

/// An array whose i-th number is computed while it is written.
template <class T, class F>
DataArray computed(std::string type, std::string name, std::size_t count, const F& valueOf) {
  return {std::move(type), std::move(name), 1, count * sizeof(T),
          [count, valueOf](OutputFile& output, LoopProgress& progress) {
            for (std::size_t i = 0; i < count; ++i) {
              const T value = static_cast<T>(valueOf(i));
              output.writeBytes(&value, sizeof(T));
              if (i % kSliceBytes == 0) progress.advance(0);
            }
            progress.advance(count * sizeof(T));
          }};
}

/// An array of integers: 32-bit if they fit, since every reader takes those.
template <class F>
DataArray computedIntegers(std::string name, std::size_t count, std::uint64_t largest,
                           const F& valueOf) {
  if (largest <= static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max())) {
    return computed<std::int32_t>("Int32", std::move(name), count, valueOf);
  }
  return computed<std::int64_t>("Int64", std::move(name), count, valueOf);
}

Section cellsSection(const HexMesh& mesh) {
  const std::size_t cells = mesh.cells.size();
  const std::size_t corners = cells * kCornersPerCell;
  // Vertex indices that fit in 31 bits have the same bytes with and without a sign.
  DataArray connectivity =
      mesh.points.size() <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())
          ? fromMemory("Int32", "connectivity", 1, mesh.cells)
          : computed<std::int64_t>("Int64", "connectivity", corners, [&mesh](std::size_t i) {
              return mesh.cells[i / kCornersPerCell][i % kCornersPerCell];
            });
  return {"Cells",
          {std::move(connectivity),
           computedIntegers("offsets", cells, corners,
                            [](std::size_t i) { return (i + 1) * kCornersPerCell; }),
           computed<std::uint8_t>("UInt8", "types", cells,
                                  [](std::size_t /*cell*/) { return kVtkHexahedron; })}};
}

std::vector<Section> describe(const HexMesh& mesh, const Array<double>& quality) {
  Section pointData{"PointData", {}};
  if (!mesh.generatorCorners.empty()) {
    pointData.arrays.push_back(computed<std::uint8_t>(
        "UInt8", "generator_kind", mesh.points.size(), [&mesh](std::size_t v) {
          return static_cast<std::uint8_t>(generatorKind(mesh.generatorCorners[v]));
        }));
  }
  return {std::move(pointData),
          {"CellData", {fromMemory("Float64", "scaled_jacobian", 1, quality)}},
          {"Points", {fromMemory("Float64", "Points", 3, mesh.points)}},
          cellsSection(mesh)};
}

/// The head, up to where the data begin.
std::string xmlHead(const HexMesh& mesh, const std::vector<Section>& sections) {
  const bool little = std::endian::native == std::endian::little;
  std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"";
  xml += std::string(" byte_order=\"") + (little ? "LittleEndian" : "BigEndian") + "\"";
  xml += " header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"" +
         std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
         std::to_string(mesh.cells.size()) + "\">\n";
  std::uint64_t offset = 0;
  for (const Section& section : sections) {
    xml += "      <" + section.name + ">\n";
    for (const DataArray& array : section.arrays) {
      // Left out where it is 1: some readers would make a matrix with one column of it.
      const std::string components =
          array.components == 1
              ? ""
              : " NumberOfComponents=\"" + std::to_string(array.components) + "\"";
      xml += "        <DataArray type=\"" + array.type + "\" Name=\"" + array.name + "\"" +
             components + " format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
      offset += sizeof(array.bytes) + array.bytes;
    }
    xml += "      </" + section.name + ">\n";
  }
  return xml + "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n    _";
}

}  // namespace

void writeVtu(const HexMesh& mesh, const std::filesystem::path& file, Context& context) {
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const Array<double> quality = scaledJacobians(mesh, context);
  Stage stage(context, "write mesh");
  const std::vector<Section> sections = describe(mesh, quality);
  std::uint64_t total = 0;
  for (const Section& section : sections) {
    for (const DataArray& array : section.arrays) total += array.bytes;
  }
  LoopProgress progress(stage, total);
  output.write(xmlHead(mesh, sections));
  for (const Section& section : sections) {
    for (const DataArray& array : section.arrays) {
      output.writeBytes(&array.bytes, sizeof(array.bytes));
      array.write(output, progress);
    }
  }
  output.write("\n  </AppendedData>\n</VTKFile>\n");
  output.commit();
}

}  // namespace hexhex
