// Conversions between maps and hex meshes, whose cells are lists of corners, and polyhedral meshes,
// whose cells are lists of half-faces.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/features.hpp>
#include <hexhex/types.hpp>

#include <base/concat.hpp>
#include <base/low_level.hpp>
#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

/// Converts a mesh to a map.
/// @param fileName  for error messages
/// @throws Error FileUnsupported if a cell is not a tet or there is no map; FileSyntax if cells are
///         invalid; NotFinite
[[nodiscard]] TetMap toTetMap(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// Converts a mesh to tets, ignoring a map if there is one.
[[nodiscard]] TetCells toTetCells(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// Converts a mesh to a hex mesh. Half-faces may be in any order; if most cells are inverted, all
/// are reversed.
/// @throws Error FileUnsupported if a cell is not a hexahedron; FileSyntax if cells are invalid
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

/// Whether valueOf(i) is negative more often than positive, for i in [0, n).
template <class F>
[[nodiscard]] bool areMostlyNegative(Stage& stage, std::size_t n, const F& valueOf) {
  constexpr std::size_t kGrain = 4096;
  std::atomic<std::int64_t> balance{0};
  parallelBlocks(stage, n, kGrain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    std::int64_t local = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double value = valueOf(i);
      local += value > 0 ? 1 : (value < 0 ? -1 : 0);
    }
    balance.fetch_add(local, std::memory_order_relaxed);
  });
  return balance.load() < 0;
}

/// Whether two corners are the same vertex.
template <std::size_t corners>
[[nodiscard]] bool hasVertexTwice(const std::array<Index, corners>& cell) noexcept {
  Index alike = 0;  // pairs of equal corners, each paired with itself, too
  for (const Index a : cell) {
    for (const Index b : cell) alike += a == b ? 1U : 0U;
  }
  return alike > corners;
}

/// Corner orders of a hexahedron, as numbered by the property CornerOrder. The first face is always
/// the same: orders 0 to 3 start at that corner of it, 4 to 7 run in the other direction.
inline constexpr std::size_t kHexOrders = 8;
[[nodiscard]] Hex inHexOrder(const Hex& assembled, std::size_t order) noexcept;

/// The n vertices of a face in loop order; all kNone if it is not a closed loop of n half-edges.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfFace(const OvmTopology& topology, std::size_t face) {
  const std::span<const Index> halfEdges = topology.faces[face];
  std::array<Index, n> loop;
  bool closed = halfEdges.size() == n;
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

/// The part of buildOvmTopology() that numbers hexahedra once their faces are matched.
/// @return empty if a cell has a vertex twice
[[nodiscard]] std::optional<OvmTopology> numberHexes(std::size_t vertexCount,
                                                     std::span<const Hex> cells,
                                                     adjacency::HexMates mates, Stage& stage);

/// @param what  plural, e.g. "edges"
/// @throws Error TooLarge if there are more than the format supports
void requireOvmCount(std::uint64_t limit, std::uint64_t count, const char* what);

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

// Shared by tets and hexahedra: building cells from half-faces.

/// Builds cells from a mesh that was read.
/// @tparam orders  number of corner orders that the property CornerOrder distinguishes
template <std::size_t corners, std::size_t orders>
class OvmCellReader {
  using Cell = std::array<Index, corners>;
  static constexpr CellKind kKind = kCellKind<corners>;
  static constexpr std::size_t kFaces = adjacency::kFaceCount<Cell>;
  static constexpr std::size_t kFaceCorners = adjacency::kFaceSize<Cell>;

 public:
  /// @param fileName  must outlive this
  OvmCellReader(OvmMesh&& mesh, const std::string& fileName, Stage& stage)
      : mesh_(std::move(mesh)),
        topology_(mesh_.topology),
        properties_(mesh_.properties),
        fileName_(fileName),
        stage_(stage),
        loops_(topology_.faces.size()) {
    parallelFor(stage, loops_.size(), kGrain,
                [this](std::size_t f) { loops_[f] = loopOfFace<kFaceCorners>(topology_, f); });
  }

 protected:
  /// Calls read(cell, loops of its half-faces, number of its corner order) for all cells, in
  /// parallel. read() returns false if the half-faces do not bound a cell, or its data are invalid.
  /// @return the first cell for which it returned false, or the number of cells
  /// @throws Error as requireProper()
  template <class Read>
  [[nodiscard]] std::size_t firstUnreadable(const Read& read) const {
    if (topology_.cells.length != kFaces) requireProper();
    Array<char> used(2 * topology_.faces.size(), 0);
    const std::size_t cells = topology_.cells.size();
    const auto isGood = [&](std::size_t c) {
      if (c + kAhead < cells) {
        for (const Index halfFace : topology_.cells[c + kAhead]) {
          prefetch(&used[halfFace]);
          prefetch(&loops_[halfFace / 2]);
        }
      }
      for (const Index halfFace : topology_.cells[c]) {
        std::atomic_ref(used[halfFace]).store(1, std::memory_order_relaxed);
      }
      return readCell(c, read);
    };
    const std::size_t fault = firstFault(stage_, cells, isGood, kGrain);
    // No half-face is used twice if there are as many different ones as uses.
    const auto different = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
    if (fault < cells || different < topology_.cells.handles.size()) requireProper();
    return fault;
  }

  /// Calls read() for one cell.
  template <class Read>
  bool readCell(std::size_t cell, const Read& read) const {
    std::array<std::array<Index, kFaceCorners>, kFaces> loops;
    for (std::size_t s = 0; s < kFaces; ++s) {
      const Index halfFace = topology_.cells[cell][s];
      loops[s] = loopOfHalfFace(loops_[halfFace / 2], halfFace);
    }
    const Array<std::int32_t>& numbers = properties_[OvmInteger::CornerOrder];
    const auto order = static_cast<std::size_t>(numbers.empty() ? 0 : numbers[cell]);
    return order < orders && read(cell, loops, order);
  }

  /// Throws unless all cells have the right number of half-faces, no half-face is used twice, and
  /// all have valid loops.
  void requireProper() const {
    const auto fail = [&](std::size_t cell, ErrorCode code, const std::string& sentence) {
      throw Error(code, concat(fileName_, ": cell ", cell, " ", sentence),
                  Place{PlaceKind::Cell, cell});
    };
    Array<char> used(2 * topology_.faces.size(), 0);
    for (std::size_t c = 0; c < topology_.cells.size(); ++c) {
      const std::span<const Index> halfFaces = topology_.cells[c];
      if (halfFaces.size() != kFaces) {
        fail(c, ErrorCode::FileUnsupported,
             concat("has ", halfFaces.size(), " faces; here, all cells must be ", kKind.plural,
                    " with ", kFaces, "."));
      }
      for (const Index halfFace : halfFaces) {
        if (!isGoodFace(halfFace / 2)) {
          fail(c, ErrorCode::FileSyntax,
               concat("has face ", halfFace / 2, ", which is no closed loop of ", kFaceCorners,
                      " half-edges."));
        }
        if (std::exchange(used[halfFace], 1) != 0) {
          fail(c, ErrorCode::FileSyntax,
               concat("has half-face ", halfFace,
                      " a second time, or another cell has it. Each side of a face belongs to one "
                      "cell."));
        }
      }
    }
  }

  /// Throws an error about a cell whose half-faces do not bound one.
  [[noreturn]] void failToBound(std::size_t cell) const {
    throw Error(ErrorCode::FileSyntax,
                concat(fileName_, ": the half-faces of cell ", cell, " do not bound a ",
                       kKind.singular, ", or its corner order is not from 0 to ", orders - 1, "."),
                Place{kKind.place, cell});
  }

  /// @param faces  the faces of `features`
  template <class Features, class FaceFeature>
  void readFeatures(Features& features, std::vector<FaceFeature>& faces) const {
    forEachTag(OvmInteger::FeatureVertices, [&](std::size_t v, std::int32_t tag) {
      features.vertices.push_back({static_cast<Index>(v), tag});
    });
    forEachTag(OvmInteger::FeatureEdges, [&](std::size_t e, std::int32_t tag) {
      features.edges.push_back({topology_.edges[e], tag});
    });
    forEachTag(OvmInteger::FeatureFaces, [&](std::size_t f, std::int32_t tag) {
      if (!isGoodFace(f)) {
        throw Error(
            ErrorCode::FileSyntax,
            concat(fileName_, ": face ", f, " is tagged as a feature, but is no closed loop of ",
                   kFaceCorners, " half-edges."));
      }
      faces.push_back({loops_[f], tag});
    });
  }

  /// Calls f(element, value) for all elements with a nonzero value.
  template <class F>
  void forEachTag(OvmInteger property, const F& f) const {
    const Array<std::int32_t>& tags = properties_[property];
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (tags[i] != 0) f(i, tags[i]);
    }
  }

  OvmMesh mesh_;
  const OvmTopology& topology_;
  const OvmProperties& properties_;
  const std::string& fileName_;
  Stage& stage_;

 private:
  static constexpr std::size_t kGrain = 2048;
  /// Prefetch distance: the faces of a cell may be scattered in memory. Without prefetching,
  /// reading a mesh with cells in random order takes 50 % longer.
  static constexpr std::size_t kAhead = 16;

  [[nodiscard]] bool isGoodFace(std::size_t face) const { return loops_[face][0] != kNone; }

  /// The vertices of each face in loop order, as of half-face 2f; kNone if it is not a closed loop
  /// of the expected length.
  Array<std::array<Index, kFaceCorners>> loops_;
};

// Features and regions, converted between lists of the few tagged elements and properties with a
// value per element.

/// Sets the value of one element, which must exist and have none yet.
/// @param element  index, or kNone; @param what  e.g. "feature edge 3-17", for the message
inline void setOvmValue(Array<std::int32_t>& values, Index element, std::int32_t value,
                        const std::string& what, Place place) {
  if (element >= values.size()) {
    throw Error(ErrorCode::InvalidArgument, "The " + what + " is not in the mesh.", place);
  }
  if (values[element] != 0) {
    throw Error(ErrorCode::InvalidArgument, "The " + what + " is listed twice.", place);
  }
  values[element] = value;
}

/// Sets the tags of elements with n vertices.
/// @param features  with vertices in any order
/// @param verticesOf  the vertices of an element, in any order
/// @param nameOf, placeOf  of a feature, for messages
template <std::size_t n, class Feature, class Vertices, class Name, class At>
void setOvmTags(Array<std::int32_t>& tags, std::size_t elements, std::size_t vertexCount,
                const std::vector<Feature>& features, const Vertices& verticesOf,
                const Name& nameOf, const At& placeOf) {
  if (features.empty()) return;
  tags.assign(elements, 0);
  struct Wanted {
    const Feature* feature;
    Index element;
  };
  std::multimap<std::array<Index, n>, Wanted> wanted;
  // Filter by smallest vertex: all elements are checked, but few have one that a feature has.
  Array<std::uint8_t> isSmallest(vertexCount, 0);
  for (const Feature& feature : features) {
    const auto place = wanted.emplace(sorted(feature.vertices), Wanted{&feature, kNone});
    if (place->first[0] < vertexCount) isSmallest[place->first[0]] = 1;
  }
  for (std::size_t i = 0; i < elements; ++i) {
    const std::array<Index, n> vertices = verticesOf(i);
    if (isSmallest[*std::min_element(vertices.begin(), vertices.end())] == 0) continue;
    const auto [begin, end] = wanted.equal_range(sorted(vertices));
    for (auto found = begin; found != end; ++found) found->second.element = static_cast<Index>(i);
  }
  for (const auto& [vertices, entry] : wanted) {
    setOvmValue(tags, entry.element, entry.feature->tag, nameOf(*entry.feature),
                placeOf(*entry.feature));
  }
}

/// Adds the properties of features and regions.
/// @param faces  the faces of `features`
/// @param regions  one per cell, or none
/// @throws Error InvalidArgument if they refer to a missing element, or to one twice; or if the
///         number of regions is wrong
template <std::size_t n, class Features, class FaceFeature, class Regions>
void setOvmFeatures(OvmProperties& properties, const OvmTopology& topology,
                    const Features& features, const std::vector<FaceFeature>& faces,
                    const Regions& regions) {
  if (!features.vertices.empty()) {
    Array<std::int32_t>& tags = properties[OvmInteger::FeatureVertices];
    tags.assign(topology.vertexCount, 0);
    for (const auto& [vertex, tag] : features.vertices) {
      setOvmValue(tags, vertex, tag, concat("feature vertex ", vertex),
                  {PlaceKind::Vertex, vertex});
    }
  }
  const auto placeOf = [](const FeatureEdge& feature) {
    return Place{PlaceKind::Edge, feature.vertices[0], feature.vertices[1]};
  };
  setOvmTags<2>(
      properties[OvmInteger::FeatureEdges], topology.edges.size(), topology.vertexCount,
      features.edges, [&](std::size_t e) { return topology.edges[e]; },
      [&](const FeatureEdge& feature) { return "feature " + toString(placeOf(feature)); }, placeOf);
  if (!faces.empty()) {
    const auto nameOf = [](const FaceFeature& feature) {
      std::string name = "feature face";
      for (const Index vertex : feature.vertices)
        name.append(1, ' ').append(std::to_string(vertex));
      return name;
    };
    setOvmTags<n>(
        properties[OvmInteger::FeatureFaces], topology.faces.size(), topology.vertexCount, faces,
        [&](std::size_t f) { return loopOfFace<n>(topology, f); }, nameOf,
        [](const FaceFeature& /*feature*/) { return Place{}; });
  }
  if (!regions.empty() && regions.size() != topology.cells.size()) {
    throw Error(ErrorCode::InvalidArgument,
                concat("The mesh has ", topology.cells.size(), " cells, but regions for ",
                       regions.size(), "."));
  }
  properties[OvmInteger::Region].assign(regions.begin(), regions.end());
}

}  // namespace hexhex::io
