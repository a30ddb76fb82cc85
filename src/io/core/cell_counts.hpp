// Points and cells of one kind, as read from files that may also hold other cells; and meshes with
// cells of several kinds.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex::io {

/// Tetrahedra with their points. Corners are in VTK order.
struct TetCells {
  Array<Vec3> points;
  Array<Tet> cells;
  Features features = {};
  Array<std::int32_t> regions = {};
};

[[nodiscard]] inline std::vector<FeatureFace>& facesIn(Features& features) {
  return features.faces;
}
[[nodiscard]] inline std::vector<FeatureQuad>& facesIn(HexFeatures& features) {
  return features.quads;
}

/// The mesh that readers build from hexahedra (8 corners) or tetrahedra (4).
template <std::size_t corners>
using CellMesh = std::conditional_t<corners == 8, HexMesh, TetCells>;

/// A kind of elements: its names in messages and its codes in file formats.
struct CellKind {
  std::size_t corners = 0;
  std::string_view singular;
  std::string_view plural;
  std::int64_t vtkType = 0;
  PlaceKind place = PlaceKind::None;
};

template <std::size_t corners>
inline constexpr CellKind kCellKind = {};
template <>
inline constexpr CellKind kCellKind<4> = {4, "tetrahedron", "tetrahedra", 10, PlaceKind::Tet};
template <>
inline constexpr CellKind kCellKind<8> = {8, "hexahedron", "hexahedra", 12, PlaceKind::Cell};
template <>
inline constexpr CellKind kCellKind<20> = {20, "hexahedron with 20 nodes",
                                           "hexahedra with 20 nodes", 25, PlaceKind::Cell};
template <>
inline constexpr CellKind kCellKind<27> = {27, "hexahedron with 27 nodes",
                                           "hexahedra with 27 nodes", 29, PlaceKind::Cell};

/// Triangles that carry labels.
inline constexpr CellKind kTriangleKind = {
    .corners = 3, .singular = "triangle", .plural = "triangles", .vtkType = 5};

// The volume cells of a file, by type. Dropping some of them leaves holes in the mesh, so readers
// count them all and files.cpp decides whether to accept the file.

/// A type of volume cells and its codes in file formats; 0 where a format lacks it.
struct VolumeCells {
  std::string_view plural;
  std::int64_t vtkType = 0;
  std::int64_t gmshType = 0;
  std::uint32_t meditCode = 0;         ///< section code in `.meshb`
  std::string_view meditKeyword = {};  ///< section name in `.mesh`
  std::size_t meditVertices = 0;       ///< per cell
};

inline constexpr std::array<VolumeCells, 38> kVolumeCells = {
    {{"hexahedra", 12, 5, 10, "Hexahedra", 8},
     {"hexahedra with 20 nodes", 25, 17},
     {"hexahedra with 24 nodes", 33},
     {"hexahedra with 27 nodes", 29, 12, 33, "HexahedraQ2", 27},
     {"hexahedra with 64 nodes", 0, 92},
     {"hexahedra with 125 nodes", 0, 93},
     {"hexahedra with 216 nodes", 0, 94},
     {"hexahedra with 343 nodes", 0, 95},
     {"hexahedra with 512 nodes", 0, 96},
     {"hexahedra with 729 nodes", 0, 97},
     {"hexahedra with 1000 nodes", 0, 98},
     {"hexahedra of higher order", 67},
     {"Lagrange hexahedra", 72},
     {"Bezier hexahedra", 79},
     {"voxels", 11},
     {"tetrahedra", 10, 4, 8, "Tetrahedra", 4},
     {"tetrahedra with 10 nodes", 24, 11, 30, "TetrahedraP2", 10},
     {"tetrahedra with 20 nodes", 0, 29},
     {"tetrahedra with 35 nodes", 0, 30},
     {"tetrahedra with 56 nodes", 0, 31},
     {"tetrahedra of higher order", 64},
     {"Lagrange tetrahedra", 71},
     {"Bezier tetrahedra", 78},
     {"prisms", 13, 6, 9, "Prisms", 6},
     {"prisms with 12 nodes", 31},
     {"prisms with 15 nodes", 26, 18},
     {"prisms with 18 nodes", 32, 13, 86, "PrismsP2", 18},
     {"prisms of higher order", 65},
     {"Lagrange prisms", 73},
     {"Bezier prisms", 80},
     {"pyramids", 14, 7, 49, "Pyramids", 5},
     {"pyramids with 13 nodes", 27, 19},
     {"pyramids with 14 nodes", 0, 14, 87, "PyramidsP2", 14},
     {"pyramids with 19 nodes", 37},
     {"pyramids of higher order", 66},
     {"Lagrange pyramids", 74},
     {"Bezier pyramids", 81},
     {"polyhedra", 42}}};

/// "tetrahedron", "prism with 15 nodes".
[[nodiscard]] std::string singular(std::string_view plural);

/// The type of cells with this number of nodes: 4, 5, 6 or 8, which are straight, or 27.
constexpr const VolumeCells& typeWith(std::size_t nodes) {
  return *std::find_if(kVolumeCells.begin(), kVolumeCells.end(),
                       [nodes](const VolumeCells& type) { return type.meditVertices == nodes; });
}

/// Something for each kind of straight cells, by their corners.
template <class T>
struct ByCorners {
  T tet, pyramid, prism, hexahedron;

  [[nodiscard]] constexpr const T& operator[](std::size_t corners) const {
    return corners == 4 ? tet : (corners == 5 ? pyramid : (corners == 6 ? prism : hexahedron));
  }
};

/// Local corners of faces, counter-clockwise seen from outside. Triangles repeat the last one.
using FaceRows = std::array<std::array<std::uint8_t, 4>, 6>;
inline constexpr ByCorners<FaceRows> kFaces = {
    {{{0, 2, 1, 1}, {0, 1, 3, 3}, {1, 2, 3, 3}, {2, 0, 3, 3}}},
    {{{0, 3, 2, 1}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}}},
    {{{0, 2, 1, 1}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
    adjacency::kHexFaces};
inline constexpr ByCorners<std::size_t> kFaceCounts = {4, 5, 5, 6};
/// A format's numbers of these faces, from 1 on.
using SideNumbers = ByCorners<std::array<std::uint8_t, 6>>;

/// A face of a cell.
[[nodiscard]] inline Quad faceAt(std::span<const Index> cell, std::size_t face) {
  const auto& row = kFaces[cell.size()][face];
  return {cell[row[0]], cell[row[1]], cell[row[2]], cell[row[3]]};
}
[[nodiscard]] inline std::size_t cornersOf(const Quad& face) { return face[2] == face[3] ? 3 : 4; }

/// The hexahedra of a mesh, then its other cells by kind.
class AllCells {
 public:
  /// @param mesh, others  must outlive this
  AllCells(const HexMesh& mesh, const OtherCells& others) : mesh_(mesh), others_(others) {}

  [[nodiscard]] const OtherCells& others() const noexcept { return others_; }
  [[nodiscard]] std::size_t size() const { return mesh_.cells.size() + others_.count(); }
  [[nodiscard]] std::span<const Index> operator[](std::size_t i) const;
  /// Empty if no cell has one.
  [[nodiscard]] Array<std::int32_t> regions() const;

 private:
  const HexMesh& mesh_;
  const OtherCells& others_;
};

/// Views numbers as rows.
template <std::size_t n>
[[nodiscard]] std::span<const std::array<Index, n>> inRows(const Array<Index>& numbers) {
  return {reinterpret_cast<const std::array<Index, n>*>(numbers.data()), numbers.size() / n};
}

/// Calls f(cells) for each kind of other cells that there is, with a span of arrays of corners.
template <class F>
void forEachOtherKind(const OtherCells& others, const F& f) {
  const auto visit = [&f](auto cells) {
    if (!cells.empty()) f(cells);
  };
  visit(inRows<4>(others.kinds[0].vertices));
  visit(inRows<5>(others.kinds[1].vertices));
  visit(inRows<6>(others.kinds[2].vertices));
}

[[nodiscard]] const OtherCells& noOthers();
/// Cells to write beside hexahedra.
[[nodiscard]] inline const OtherCells& othersOf(const WriteOptions& options) {
  return options.others == nullptr ? noOthers() : *options.others;
}

/// The volume cell type with this number in a format; null if there is none.
[[nodiscard]] const VolumeCells* volumeCells(std::int64_t VolumeCells::*number, std::int64_t value);

class CellCounts {
 public:
  /// Adds cells by VTK's type. Points, lines and polygons are not counted.
  void addVtk(std::int64_t type, std::uint64_t count);
  void add(const VolumeCells& type, std::uint64_t count) { counts_[type.plural] += count; }
  void add(const CellKind& kind, std::uint64_t count) { addVtk(kind.vtkType, count); }

  [[nodiscard]] std::uint64_t of(const CellKind& kind) const;
  /// Refuses a file that also holds cells of other kinds.
  /// @param advice  how to proceed, appended to the message
  /// @param read    those that are not refused
  /// @throws Error FileUnsupported
  void requireOnly(const CellKind& kind, const std::string& fileName, std::string_view advice,
                   const OtherCells& read = noOthers()) const;

  [[nodiscard]] std::vector<CellCount> list() const;
  /// "; it holds 1 prism and 8 hexahedra with 27 nodes", to end messages about files that lack
  /// cells of a kind; empty if the file has no volume cells.
  [[nodiscard]] std::string instead() const;
  /// A sentence to follow instead() where straight hexahedra are wanted; empty if the file has no
  /// hexahedra of order 2.
  [[nodiscard]] std::string adviceOnCurved() const;

  /// "1 prism and 8 hexahedra with 27 nodes".
  [[nodiscard]] std::string text() const;

 private:
  std::map<std::string_view, std::uint64_t> counts_;
  std::map<std::int64_t, std::uint64_t> unknown_;  ///< VTK types not in the table
};

}  // namespace hexhex::io
