// The content of `.ovm` and `.ovmb` files: a polyhedral mesh of vertices, edges, faces and cells,
// and those of their properties that this library supports; and its readers and writers.
//
// Half-edge 2e is edge e as stored, 2e + 1 its reverse. Half-face 2f is face f as stored (a closed
// loop of half-edges), 2f + 1 its reverse.
//
// Text files have the sections Vertices, Edges, Faces, Polyhedra, each with a count and one element
// per line; then properties: a line `HFProp vec3d "name"`, and a value per element. Binary files
// are a header and chunks (ovmb.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

/// The kind of elements that a property is attached to; numbered as in `.ovmb`.
enum class OvmEntity : std::uint8_t { Vertex, Edge, Face, Cell, HalfEdge, HalfFace, Mesh };

/// Names of vertices, edges, faces and cells in files and messages.
struct OvmElements {
  const char* section;  ///< in `.ovm`
  const char* one;
  const char* many;
  const char* parts;           ///< what an element consists of
  std::uint32_t leastValence;  ///< fewer half-edges or half-faces enclose nothing
  std::size_t fewestBytes;     ///< of the shortest line and its end, e.g. "0 0 0", "0 1", "3 0 2 4"
};
/// By entity.
inline constexpr std::array<OvmElements, 4> kOvmElements = {
    {{"Vertices", "vertex", "vertices", "", 0, 6},
     {"Edges", "edge", "edges", "vertex", 2, 4},
     {"Faces", "face", "faces", "half-edge", 3, 8},
     {"Polyhedra", "cell", "cells", "half-face", 4, 10}}};

/// By entity: the keyword in `.ovm` that begins a property.
inline constexpr std::array<std::string_view, 7> kOvmPropertyWords = {
    "VProp", "EProp", "FProp", "CProp", "HEProp", "HFProp", "MProp"};

/// Maximum number of entities of a kind, so that indices of half-entities fit in 32 bits. It is
/// also the limit of OpenVolumeMesh.
inline constexpr std::uint64_t kMaxOvmEntities = (std::uint64_t{1} << 31) - 1;

/// Lists of handles, concatenated.
struct OvmLists {
  Array<Index> handles;
  std::size_t length = 0;                       ///< of all lists; 0 if they differ
  std::span<const std::uint64_t> offsets = {};  ///< if they differ: where lists begin, and the end

  [[nodiscard]] std::size_t size() const noexcept {
    if (length > 0) return handles.size() / length;
    return offsets.empty() ? 0 : offsets.size() - 1;
  }
  /// @pre  all lists have the same length
  [[nodiscard]] std::span<const Index> operator[](std::size_t i) const noexcept {
    return {handles.data() + i * length, length};
  }
};

struct OvmTopology {
  std::size_t vertexCount = 0;
  Array<std::array<Index, 2>> edges;  ///< from, to
  OvmLists faces;                     ///< half-edges in loop order
  OvmLists cells;                     ///< half-faces

  [[nodiscard]] std::size_t count(OvmEntity entity) const noexcept {
    const std::array<std::size_t, 7> counts = {vertexCount,
                                               edges.size(),
                                               faces.size(),
                                               cells.size(),
                                               2 * edges.size(),
                                               2 * faces.size(),
                                               1};
    return counts[static_cast<std::size_t>(entity)];
  }
  /// The start vertex of a half-edge.
  [[nodiscard]] Index from(Index halfEdge) const noexcept {
    return edges[halfEdge / 2][halfEdge % 2];
  }
  /// The end vertex of a half-edge.
  [[nodiscard]] Index to(Index halfEdge) const noexcept { return from(halfEdge ^ 1U); }
};

/// The map: for each half-face, the parameters of the opposite vertex in its cell, in the cell's
/// chart. Values of half-faces without a cell have no meaning.
inline constexpr std::string_view kParametrizationName = "HexHex::Parametrization";

/// Properties of integers (C++ `int`) that are read and written, in the order of writing.
enum class OvmInteger : std::uint8_t {
  FeatureVertices,
  GeneratorType,     ///< of hex meshes: dimension of the tet simplex that contains the vertex
  GeneratorTet,      ///< the simplex as in HexMesh, to restore it exactly
  GeneratorCorners,  ///< likewise
  EdgeValence,
  FeatureEdges,
  FeatureFaces,
  Transition,
  CornerOrder,  ///< of cells: the order of their corners, which the format does not define
  Region        ///< of cells: TetMap::regions, HexMesh::regions
};

struct OvmIntegerName {
  OvmEntity entity;
  std::string_view name;  ///< some are misspelt, as in other programs
};
inline constexpr std::array<OvmIntegerName, 10> kOvmIntegers = {
    {{OvmEntity::Vertex, "AlgoHex::FeatureVertices"},
     {OvmEntity::Vertex, "v_tet_generator_type"},
     {OvmEntity::Vertex, "hexhex::generator_tet"},
     {OvmEntity::Vertex, "hexhex::generator_corners"},
     {OvmEntity::Edge, "edge_valance"},
     {OvmEntity::Edge, "AlgoHex::FeatureEdges"},
     {OvmEntity::Face, "AlgoHex::FeatureFaces"},
     {OvmEntity::HalfFace, "HalffaceTransiton"},
     {OvmEntity::Cell, "hexhex::corner_order"},
     {OvmEntity::Cell, "hexhex::region"}}};

/// A property to write: integers, points, or pairs of numbers.
struct OvmProperty {
  OvmEntity entity = OvmEntity::Vertex;
  std::string_view name;
  std::variant<Array<std::int32_t>, Array<Vec3>, Array<std::array<double, 2>>> values = {};
};

/// Values of the supported properties, one per element; empty if a property is missing.
struct OvmProperties {
  Array<Vec3> parametrization;  ///< per half-face
  std::array<Array<std::int32_t>, kOvmIntegers.size()> integers;

  [[nodiscard]] Array<std::int32_t>& operator[](OvmInteger property) noexcept {
    return integers[static_cast<std::size_t>(property)];
  }
  [[nodiscard]] const Array<std::int32_t>& operator[](OvmInteger property) const noexcept {
    return integers[static_cast<std::size_t>(property)];
  }
  /// All properties present, in the order of writing.
  [[nodiscard]] std::vector<OvmProperty> listed() && {
    std::vector<OvmProperty> list;
    for (std::size_t i = 0; i < integers.size(); ++i) {
      if (i == static_cast<std::size_t>(OvmInteger::Transition) && !parametrization.empty()) {
        list.push_back({OvmEntity::HalfFace, kParametrizationName, std::move(parametrization)});
      }
      if (integers[i].empty()) continue;
      list.push_back({kOvmIntegers[i].entity, kOvmIntegers[i].name, std::move(integers[i])});
    }
    return list;
  }
};

/// The kind of a property's values.
enum class OvmNumbers : std::uint8_t { Integers, Points, Others };

/// A mesh as read, for cells of one kind.
struct OvmMesh {
  explicit OvmMesh(const CellKind& kind) {
    topology.faces.length = kind.corners == 4 ? 3 : 4;
    topology.cells.length = kind.corners == 4 ? 4 : 6;
  }
  /// Notes a list of another length than wanted, which is filled with kNone.
  void noteOther(const OvmLists& lists, std::size_t i, std::uint64_t length) {
    if (&lists == &topology.cells && !otherCell) otherCell = {i, length};
  }

  Array<Vec3> points;
  OvmTopology topology;
  OvmProperties properties;
  /// The first cell with another number of faces than wanted, and that number.
  std::optional<std::pair<std::size_t, std::uint64_t>> otherCell = {};
  /// Whether a property has the map's name but another type; for error messages.
  bool hasForeignParametrization = false;

  /// The target for a property's values. Both are null if it is unknown or a repetition.
  struct Destination {
    Array<Vec3>* points = nullptr;
    Array<std::int32_t>* integers = nullptr;
  };
  [[nodiscard]] Destination destinationOf(OvmEntity entity, std::string_view name,
                                          OvmNumbers numbers) {
    if (name == kParametrizationName) {
      const bool isMap = entity == OvmEntity::HalfFace && numbers == OvmNumbers::Points;
      Array<Vec3>& values = properties.parametrization;
      if (isMap && values.empty()) return {.points = &values};
      hasForeignParametrization = true;
    }
    for (std::size_t i = 0; i < kOvmIntegers.size(); ++i) {
      if (kOvmIntegers[i].entity != entity || kOvmIntegers[i].name != name) continue;
      Array<std::int32_t>& values = properties.integers[i];
      if (numbers == OvmNumbers::Integers && values.empty()) return {.integers = &values};
    }
    return {};
  }
};

/// A mesh to write.
struct OvmOutput {
  std::span<const Vec3> points;  ///< of the source mesh
  OvmTopology topology;
  std::vector<OvmProperty> properties;  ///< in the order of writing
  bool hasWideHandles = false;  ///< whether `.ovmb` handles have four bytes even if fewer would do
};

inline constexpr std::string_view kOvmbMagic = "OVMB\n\r\n\xff";
/// Whether a file begins like an `.ovmb` file.
[[nodiscard]] inline bool isOvmb(std::string_view bytes) noexcept {
  return bytes.starts_with(kOvmbMagic);
}

/// Read the mesh and the supported properties. Handles are checked to be in range; the topology is
/// not checked otherwise.
/// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite, TooLarge, with the line
///         or byte
using ParseOvm = OvmMesh(std::string_view bytes, const std::string& fileName, const CellKind& kind,
                         Stage& stage);
ParseOvm parseOvmText, parseOvmb;

/// Write a mesh in the layout of OpenVolumeMesh's own files: one chunk or section for each kind of
/// element, handles without offset. Numbers in `.ovm` have the fewest digits that read back to the
/// same double.
/// @param mesh  for `.ovm`: all faces have equal valence, and so have all cells
/// @throws Error FileWrite
void writeOvmText(const OvmOutput& mesh, OutputFile& output, Stage& stage);
void writeOvmb(const OvmOutput& mesh, OutputFile& output, Stage& stage);

// Conversions between maps and hex meshes, whose cells are lists of corners, and polyhedral meshes,
// whose cells are lists of half-faces.

/// Converts a mesh of tets to a map.
/// @param fileName  for error messages
/// @throws Error FileUnsupported if a cell is no tet or there is no map; FileSyntax if cells are
///         invalid; NotFinite
[[nodiscard]] TetMap toTetMap(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// Converts a mesh of tets, ignoring a map if there is one.
[[nodiscard]] TetCells toTetCells(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// Converts a mesh of hexahedra. Half-faces may be in any order; if most cells are inverted, all
/// are reversed.
/// @throws Error FileUnsupported if a cell is no hexahedron; FileSyntax if cells are invalid
[[nodiscard]] HexMesh toHexMesh(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// The content of a file. Half-faces point into their cells, and the loops of a cell's first slots
/// start at its first corner where neighbours allow it; elsewhere, the property CornerOrder gives
/// the order.
/// @param mesh  with corners and generators in range
/// @throws Error InvalidArgument if array sizes disagree, or features or valences refer to elements
///         that are not in the mesh; IndexOutOfRange, RepeatedVertex, NotFinite, NonManifoldFace,
///         Orientation, TooLarge
[[nodiscard]] OvmOutput toOvm(const TetMap& map, Stage& stage);
[[nodiscard]] OvmOutput toOvm(const HexMesh& mesh, Stage& stage);

/// The topology of a map's file.
/// @param tets  with vertices in range
[[nodiscard]] OvmTopology ovmTopologyOf(std::span<const Vec3> points, std::span<const Tet> tets,
                                        Stage& stage);

/// Whether two corners are the same vertex.
template <std::size_t corners>
[[nodiscard]] bool hasVertexTwice(const std::array<Index, corners>& cell) noexcept {
  Index alike = 0;  // pairs of equal corners, each paired with itself, too
  for (const Index a : cell) {
    for (const Index b : cell) alike += a == b ? 1U : 0U;
  }
  return alike > corners;
}

/// Assembles the hexahedron with these six faces in VTK order: the loop of the first one, then the
/// vertices joined to it by edges. Its volume is positive if loops are counter-clockwise seen from
/// inside.
/// @return false if they do not bound a hexahedron
using QuadLoops = std::array<std::array<Index, 4>, 6>;
[[nodiscard]] bool assembleHex(const QuadLoops& loops, Hex& hex);

/// Corner orders of a hexahedron, as numbered by the property CornerOrder. The first face is always
/// the same: orders 0 to 3 start at that corner of it, 4 to 7 run in the other direction.
inline constexpr std::size_t kHexOrders = 8;
[[nodiscard]] Hex inHexOrder(const Hex& assembled, std::size_t order) noexcept;

/// The n vertices of a face in loop order; all kNone if it is not a closed loop of n half-edges.
/// @pre  faces have n half-edges, or kNone
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfFace(const OvmTopology& topology, std::size_t face) {
  const std::span<const Index> halfEdges = topology.faces[face];
  std::array<Index, n> loop;
  bool closed = halfEdges[0] != kNone;
  for (std::size_t i = 0; closed && i < n; ++i) {
    loop[i] = topology.from(halfEdges[i]);
    closed = topology.to(halfEdges[i]) == topology.from(halfEdges[(i + 1) % n]);
  }
  if (!closed) loop.fill(kNone);
  return loop;
}

/// The same for a half-face, given the loop of its face.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfHalfFace(const std::array<Index, n>& ofFace,
                                                  Index halfFace) noexcept {
  if (halfFace % 2 == 0) return ofFace;
  std::array<Index, n> reversed;
  for (std::size_t i = 0; i < n; ++i) reversed[i] = ofFace[(n - i) % n];
  return reversed;
}

/// Faces of a tet by corners, in the order that other tools use. Counter-clockwise seen from inside
/// if det(v1 - v0, v2 - v0, v3 - v0) > 0.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kOvmTetFaces = {
    {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
/// The corner opposite each of them, and the face opposite each corner.
inline constexpr std::array<std::uint8_t, 4> kOvmTetOpposite = {3, 1, 2, 0};

/// Faces of a hexahedron in VTK order: three pairs of opposite faces, counter-clockwise seen from
/// inside.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kOvmHexFaces = {
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {3, 2, 6, 7}, {1, 5, 6, 2}, {0, 3, 7, 4}}};

/// Finds the faces and edges of cells. A face is owned by a cell that has it in the first slot of
/// its list, if there is one; half-face 2f points into the owner and starts at the first corner of
/// its slot.
///
/// For tets, edges run from the smaller to the larger vertex. Edges and faces are sorted by
/// smallest vertex; those of a vertex are in the order in which its tets have them.
///
/// For hexahedra, edges along seams (HexMates) come first, from the smaller to the larger vertex,
/// in lexicographic order; then the others, cell by cell, away from the cell's corner 0. Faces are
/// numbered cell by cell, slot by slot.
/// @param cells  corners of tets or hexahedra, vertices in range
/// @throws Error NonManifoldFace, Orientation if a face is shared by more than two cells, or by two
///         with the same orientation; RepeatedVertex; TooLarge
[[nodiscard]] OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Tet> cells,
                                           Stage& stage);
[[nodiscard]] OvmTopology buildOvmTopology(std::size_t vertexCount, std::span<const Hex> cells,
                                           Stage& stage);

/// Finds edges in a list sorted by their smaller vertices, which come first.
class OvmEdgeFinder {
 public:
  /// @param edges  of tets, or of hexahedra along seams
  OvmEdgeFinder(std::size_t vertexCount, std::span<const std::array<Index, 2>> edges);
  /// The edge between two vertices, or kNone.
  [[nodiscard]] Index find(Index a, Index b) const noexcept;
  /// The half-edge between two vertices. @pre  the edge exists
  [[nodiscard]] Index halfEdge(Index from, Index to) const noexcept {
    return 2 * find(from, to) + (from < to ? 0U : 1U);
  }

 private:
  std::span<const std::array<Index, 2>> edges_;
  Array<Index> begins_;  ///< per vertex (+1): start of its edges to larger vertices
};

}  // namespace hexhex::io
