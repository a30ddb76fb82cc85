// Where everything is in a `.vtu` file as this library writes it. The head and all positions follow
// from the counts, so that arrays can be written in any order, piece by piece.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hexhex {

/// What decides on the layout.
struct VtuShape {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  bool generatorTets = false;      ///< with the point array generator_tet
  bool generatorCorners = false;   ///< with the point arrays generator_kind, generator_corners
  bool scaledJacobians = false;    ///< with the cell array scaled_jacobian
  bool vertexTags = false;         ///< with the point array feature_vertex
  bool regions = false;            ///< with the cell array region
  std::uint64_t edgeTags = 0;      ///< rows of the field array feature_edges
  std::uint64_t triangleTags = 0;  ///< rows of the field array feature_triangles
  std::uint64_t quadTags = 0;      ///< rows of the field array feature_quads
  std::size_t corners = 8;         ///< of each cell
  std::string_view map = {};       ///< the name of the map's cell array; empty: there is none
};

/// What an array holds.
enum class VtuContent {
  GeneratorKind,
  GeneratorTet,
  GeneratorCorners,
  ScaledJacobian,
  VertexTags,
  Regions,
  EdgeTags,      ///< per edge: two vertices and the tag
  TriangleTags,  ///< per triangle: three vertices and the tag
  QuadTags,      ///< per quad: four vertices and the tag
  Map,
  Points,
  Connectivity,
  Offsets,
  Types
};

/// One array of the file.
struct VtuArray {
  VtuContent content = VtuContent::Points;
  std::string_view section;  ///< "FieldData", or a part of the piece, e.g. "PointData"
  std::string_view name;
  std::string_view type;  ///< VTK's name of the number type
  std::size_t components = 1;
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;
  std::uint64_t position = 0;  ///< of the data; in front of them `bytes` as 64 bits
};

/// The layout of one file.
class VtuLayout {
 public:
  explicit VtuLayout(const VtuShape& shape);

  /// The file's beginning, up to the data.
  [[nodiscard]] const std::string& head() const noexcept { return head_; }
  /// All arrays, in the order of their positions, without gaps.
  [[nodiscard]] const std::vector<VtuArray>& arrays() const noexcept { return arrays_; }
  /// The file's end, behind the last array.
  [[nodiscard]] static std::string_view tail() noexcept {
    return "\n  </AppendedData>\n</VTKFile>\n";
  }
  [[nodiscard]] std::uint64_t tailPosition() const noexcept;

  /// The same beginning for compressed arrays, with an offset for each of them. It has the same
  /// number of bytes whatever they are.
  [[nodiscard]] std::string compressedHead(std::span<const std::uint64_t> offsets) const;

  /// Whether vertex indices and offsets take 64 bits: 32-bit ones are signed, since every reader
  /// takes those.
  [[nodiscard]] bool wideConnectivity() const noexcept { return wideConnectivity_; }
  [[nodiscard]] bool wideOffsets() const noexcept { return wideOffsets_; }

 private:
  void listArrays(const VtuShape& shape);
  [[nodiscard]] std::string composeHead(std::span<const std::uint64_t> offsets,
                                        bool compressed) const;

  std::uint64_t points_;
  std::uint64_t cells_;
  bool wideConnectivity_;
  bool wideOffsets_;
  std::vector<VtuArray> arrays_;
  std::string head_;
};

}  // namespace hexhex
