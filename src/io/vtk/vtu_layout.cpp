#include <bit>
#include <limits>

#include <hexhex/types.hpp>

#include <io/vtk/vtu_layout.hpp>

namespace hexhex {
namespace {

constexpr std::uint64_t kLargestInt32 = std::numeric_limits<std::int32_t>::max();

/// In the order in which a file has them. The first stands in front of the piece.
constexpr std::string_view kSections[] = {"FieldData", "PointData", "CellData", "Points", "Cells"};
enum Section : std::uint8_t { kFieldData, kPointData, kCellData, kPoints, kCells };

/// The tag of one array. `offset` counts from the beginning of the data.
std::string tagOf(const VtuArray& array, std::uint64_t offset) {
  // Left out where it is 1: some readers would make a matrix with one column of it.
  const std::string components =
      array.components == 1 ? ""
                            : " NumberOfComponents=\"" + std::to_string(array.components) + "\"";
  // Nothing else tells the length of a field array.
  const std::string rows = array.section != kSections[kFieldData]
                               ? ""
                               : " NumberOfTuples=\"" + std::to_string(array.rows) + "\"";
  return "        <DataArray type=\"" + std::string(array.type) + "\" Name=\"" +
         std::string(array.name) + "\"" + components + rows + " format=\"appended\" offset=\"" +
         std::to_string(offset) + "\"/>\n";
}

}  // namespace

VtuLayout::VtuLayout(const VtuShape& shape)
    : points_(shape.points),
      cells_(shape.cells),
      wideConnectivity_(shape.points > kLargestInt32),
      wideOffsets_(shape.cells > kLargestInt32 / shape.corners) {
  listArrays(shape);
  std::vector<std::uint64_t> offsets;
  std::uint64_t offset = 0;
  for (const VtuArray& array : arrays_) {
    offsets.push_back(offset);
    offset += sizeof(array.bytes) + array.bytes;
  }
  head_ = composeHead(offsets, false);
  std::uint64_t position = head_.size();
  for (VtuArray& array : arrays_) {
    array.position = position + sizeof(array.bytes);
    position = array.position + array.bytes;
  }
}

void VtuLayout::listArrays(const VtuShape& shape) {
  const auto add = [this](VtuContent content, Section section, std::string_view name,
                          std::string_view type, std::size_t components, std::uint64_t rows,
                          std::uint64_t bytes) {
    const std::uint64_t all = rows * components * bytes;
    arrays_.push_back({content, kSections[section], name, type, components, rows, all, 0});
  };
  const std::uint64_t points = shape.points;
  const std::uint64_t cells = shape.cells;
  // Int64 holds vertices and tags alike.
  if (shape.edgeTags > 0) {
    add(VtuContent::EdgeTags, kFieldData, "feature_edges", "Int64", 3, shape.edgeTags, 8);
  }
  if (shape.triangleTags > 0) {
    add(VtuContent::TriangleTags, kFieldData, "feature_triangles", "Int64", 4, shape.triangleTags,
        8);
  }
  if (shape.quadTags > 0) {
    add(VtuContent::QuadTags, kFieldData, "feature_quads", "Int64", 5, shape.quadTags, 8);
  }
  if (shape.generatorCorners) {
    add(VtuContent::GeneratorKind, kPointData, "generator_kind", "UInt8", 1, points, 1);
    add(VtuContent::GeneratorCorners, kPointData, "generator_corners", "UInt8", 1, points, 1);
  }
  if (shape.generatorTets) {
    add(VtuContent::GeneratorTet, kPointData, "generator_tet", "UInt32", 1, points, 4);
  }
  if (shape.vertexTags) {
    add(VtuContent::VertexTags, kPointData, "feature_vertex", "Int32", 1, points, 4);
  }
  if (shape.scaledJacobians) {
    add(VtuContent::ScaledJacobian, kCellData, "scaled_jacobian", "Float64", 1, cells, 8);
  }
  if (shape.regions) add(VtuContent::Regions, kCellData, "region", "Int32", 1, cells, 4);
  if (!shape.map.empty()) add(VtuContent::Map, kCellData, shape.map, "Float64", 12, cells, 8);
  add(VtuContent::Points, kPoints, "Points", "Float64", 3, points, 8);
  const auto addIntegers = [&](VtuContent content, std::string_view name, std::uint64_t count,
                               bool wide) {
    add(content, kCells, name, wide ? "Int64" : "Int32", 1, count, wide ? 8 : 4);
  };
  addIntegers(VtuContent::Connectivity, "connectivity", cells * shape.corners, wideConnectivity_);
  addIntegers(VtuContent::Offsets, "offsets", cells, wideOffsets_);
  add(VtuContent::Types, kCells, "types", "UInt8", 1, cells, 1);
}

std::string VtuLayout::composeHead(std::span<const std::uint64_t> offsets, bool compressed) const {
  const bool little = std::endian::native == std::endian::little;
  std::string head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"";
  head += std::string(" byte_order=\"") + (little ? "LittleEndian" : "BigEndian") + "\"";
  head += " header_type=\"UInt64\"";
  if (compressed) head += " compressor=\"vtkZLibDataCompressor\"";
  head += ">\n  <UnstructuredGrid>\n";
  const std::string piece = "    <Piece NumberOfPoints=\"" + std::to_string(points_) +
                            "\" NumberOfCells=\"" + std::to_string(cells_) + "\">\n";
  for (const std::string_view section : kSections) {
    const bool ofField = section == kSections[kFieldData];
    if (!ofField || arrays_.front().section == section) {
      head += "      <" + std::string(section) + ">\n";
      for (std::size_t i = 0; i < arrays_.size(); ++i) {
        if (arrays_[i].section == section) head += tagOf(arrays_[i], offsets[i]);
      }
      head += "      </" + std::string(section) + ">\n";
    }
    if (ofField) head += piece;
  }
  return head + "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n    _";
}

std::string VtuLayout::compressedHead(std::span<const std::uint64_t> offsets) const {
  const std::vector<std::uint64_t> largest(arrays_.size(), ~std::uint64_t{0});
  const std::size_t size = composeHead(largest, true).size();
  std::string head = composeHead(offsets, true);
  // Space in front of the mark of the data means nothing.
  head.insert(head.size() - 1, size - head.size(), ' ');
  return head;
}

std::uint64_t VtuLayout::tailPosition() const noexcept {
  return arrays_.back().position + arrays_.back().bytes;
}

}  // namespace hexhex
