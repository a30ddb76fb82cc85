#include <bit>
#include <limits>

#include <hexhex/types.hpp>

#include <io/vtu_layout.hpp>

namespace hexhex {
namespace {

constexpr std::uint64_t kLargestInt32 = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kCornersPerCell = 8;

/// In the order in which a file has them.
constexpr std::string_view kSections[] = {"PointData", "CellData", "Points", "Cells"};

/// The tag of one array. `offset` counts from the beginning of the data.
std::string tagOf(const VtuArray& array, std::uint64_t offset) {
  // Left out where it is 1: some readers would make a matrix with one column of it.
  const std::string components =
      array.components == 1 ? ""
                            : " NumberOfComponents=\"" + std::to_string(array.components) + "\"";
  return "        <DataArray type=\"" + std::string(array.type) + "\" Name=\"" +
         std::string(array.name) + "\"" + components + " format=\"appended\" offset=\"" +
         std::to_string(offset) + "\"/>\n";
}

}  // namespace

VtuLayout::VtuLayout(const VtuShape& shape)
    : wideConnectivity_(shape.points > kLargestInt32),
      wideOffsets_(shape.cells > kLargestInt32 / kCornersPerCell) {
  listArrays(shape);
  composeHead(shape);
  std::uint64_t position = head_.size();
  for (VtuArray& array : arrays_) {
    array.position = position + sizeof(array.bytes);
    position = array.position + array.bytes;
  }
}

void VtuLayout::listArrays(const VtuShape& shape) {
  const auto add = [this](VtuContent content, std::size_t section, std::string_view name,
                          std::string_view type, std::size_t components, std::uint64_t bytes) {
    arrays_.push_back({content, kSections[section], name, type, components, bytes, 0});
  };
  const std::uint64_t points = shape.points;
  const std::uint64_t cells = shape.cells;
  if (shape.generatorCorners) {
    add(VtuContent::GeneratorKind, 0, "generator_kind", "UInt8", 1, points);
    add(VtuContent::GeneratorCorners, 0, "generator_corners", "UInt8", 1, points);
  }
  if (shape.generatorTets) {
    add(VtuContent::GeneratorTet, 0, "generator_tet", "UInt32", 1, points * sizeof(Index));
  }
  if (shape.scaledJacobians) {
    add(VtuContent::ScaledJacobian, 1, "scaled_jacobian", "Float64", 1, cells * sizeof(double));
  }
  add(VtuContent::Points, 2, "Points", "Float64", 3, points * sizeof(Vec3));
  const auto addIntegers = [&](VtuContent content, std::string_view name, std::uint64_t count,
                               bool wide) {
    add(content, 3, name, wide ? "Int64" : "Int32", 1, count * (wide ? 8 : 4));
  };
  addIntegers(VtuContent::Connectivity, "connectivity", cells * kCornersPerCell, wideConnectivity_);
  addIntegers(VtuContent::Offsets, "offsets", cells, wideOffsets_);
  add(VtuContent::Types, 3, "types", "UInt8", 1, cells);
}

void VtuLayout::composeHead(const VtuShape& shape) {
  const bool little = std::endian::native == std::endian::little;
  head_ = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"";
  head_ += std::string(" byte_order=\"") + (little ? "LittleEndian" : "BigEndian") + "\"";
  head_ += " header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"" +
           std::to_string(shape.points) + "\" NumberOfCells=\"" + std::to_string(shape.cells) +
           "\">\n";
  std::uint64_t offset = 0;
  for (const std::string_view section : kSections) {
    head_ += "      <" + std::string(section) + ">\n";
    for (const VtuArray& array : arrays_) {
      if (array.section != section) continue;
      head_ += tagOf(array, offset);
      offset += sizeof(array.bytes) + array.bytes;
    }
    head_ += "      </" + std::string(section) + ">\n";
  }
  head_ += "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n    _";
}

std::uint64_t VtuLayout::tailPosition() const noexcept {
  return arrays_.back().position + arrays_.back().bytes;
}

}  // namespace hexhex
