// Converts hex meshes, and maps on tets, to and from polyhedral meshes (see ovm_mesh.hpp).
#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/error.hpp>
#include <hexhex/features.hpp>

#include <base/concat.hpp>
#include <base/low_level.hpp>
#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <io/core/checked_sink.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

namespace {

constexpr std::size_t kOvmCellsGrain = 4096;

/// Whether valueOf(i) is negative more often than positive, for i in [0, n).
template <class F>
bool areMostlyNegative(Stage& stage, std::size_t n, const F& valueOf) {
  std::atomic<std::int64_t> balance{0};
  parallelBlocks(stage, n, kOvmCellsGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::int64_t local = 0;
                   for (std::size_t i = begin; i < end; ++i) {
                     const double value = valueOf(i);
                     local += value > 0 ? 1 : (value < 0 ? -1 : 0);
                   }
                   balance.fetch_add(local, std::memory_order_relaxed);
                 });
  return balance.load() < 0;
}

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
    if (mesh_.otherCell) requireProper();
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
    const auto fail = [&](std::size_t cell, const std::string& sentence,
                          ErrorCode code = ErrorCode::FileSyntax) {
      throw Error(code, concat(fileName_, ": cell ", cell, " ", sentence),
                  Place{PlaceKind::Cell, cell});
    };
    Array<char> used(2 * topology_.faces.size(), 0);
    for (std::size_t c = 0; c < topology_.cells.size(); ++c) {
      if (mesh_.otherCell && mesh_.otherCell->first == c) {
        fail(c,
             concat("has ", mesh_.otherCell->second, " faces; here, all cells must be ",
                    kKind.plural, " with ", kFaces, "."),
             ErrorCode::FileUnsupported);
      }
      for (const Index halfFace : topology_.cells[c]) {
        if (!isGoodFace(halfFace / 2)) {
          fail(c, concat("has face ", halfFace / 2, ", which is no closed loop of ", kFaceCorners,
                         " half-edges."));
        }
        if (std::exchange(used[halfFace], 1) != 0) {
          fail(c, concat("has half-face ", halfFace,
                         " a second time, or another cell has it. Each side of a face belongs to "
                         "one cell."));
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

/// Sets the property CornerOrder, unless all cells have the order that a reader derives.
/// @param orderOf  called with a cell
template <class OrderOf>
void setOvmOrders(OvmProperties& properties, std::size_t cells, const OrderOf& orderOf,
                  Stage& stage) {
  Array<std::int32_t> orders(cells);
  const std::size_t unlike = firstFault(stage, cells, [&](std::size_t c) {
    orders[c] = static_cast<std::int32_t>(orderOf(c));
    return orders[c] == 0;
  });
  if (unlike < cells) properties[OvmInteger::CornerOrder] = std::move(orders);
}

/// Sets the value of one element, which must exist and have none yet.
/// @param element  index, or kNone; @param what  e.g. "feature edge 3-17", for the message
void setOvmValue(Array<std::int32_t>& values, Index element, std::int32_t value,
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

// Hex meshes.

constexpr std::size_t kReversed = 4;  // added for the reverse order from the same corner

/// The position of a vertex in a loop; 4 if it is not there.
std::size_t placeIn(const std::array<Index, 4>& loop, Index vertex) {
  return static_cast<std::size_t>(std::find(loop.begin(), loop.end(), vertex) - loop.begin());
}

/// The side i of the base that a face's loop traverses in reverse; 4 if there is none, or if the
/// face shares more with the base.
std::size_t sideOfBase(const std::array<Index, 4>& base, const std::array<Index, 4>& loop) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t place = placeIn(loop, base[(i + 1) % 4]);
    if (place < 4 && loop[(place + 1) % 4] == base[i]) return i;
  }
  return 4;
}

}  // namespace

bool assembleHex(const QuadLoops& loops, Hex& hex) {
  const std::array<Index, 4>& base = loops[0];
  std::array<Index, 4> top = {kNone, kNone, kNone, kNone};
  const auto join = [&top](std::size_t i, Index vertex) {
    if (top[i] == kNone) top[i] = vertex;
    return top[i] == vertex;
  };
  unsigned sides = 0;
  std::size_t lid = 0;
  for (std::size_t s = 1; s < 6; ++s) {
    const std::size_t side = sideOfBase(base, loops[s]);
    if (side == 4) {
      lid = s;
      continue;
    }
    // The loop is base[side + 1], base[side], and the two vertices above them.
    const std::size_t place = placeIn(loops[s], base[side]);
    const bool same = join(side, loops[s][(place + 1) % 4]);
    if (!join((side + 1) % 4, loops[s][(place + 2) % 4]) || !same) return false;
    sides |= 1U << side;
  }
  if (sides != 15U || lid == 0) return false;
  hex = {base[0], base[1], base[2], base[3], top[0], top[1], top[2], top[3]};
  if (hasVertexTwice(hex)) return false;
  // The lid traverses the vertices above the base in reverse.
  const std::size_t start = placeIn(loops[lid], top[3]);
  if (start == 4) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    if (loops[lid][(start + i) % 4] != top[3 - i]) return false;
  }
  return true;
}

namespace {

/// Whether most hexahedra have a negative volume, computed from their mean edge vectors. Large
/// meshes are sampled at some ten thousand cells, since positions are scattered in memory.
bool isMostlyNegative(std::span<const Vec3> points, std::span<const Hex> cells, Stage& stage) {
  constexpr std::size_t kAsked = std::size_t{1} << 16;
  const std::size_t step = cells.size() / kAsked + 1;
  const auto volumeOf = [&](std::size_t i) {
    const Hex& hex = cells[i * step];
    const auto edges = [&](const Quad& to, const Quad& from) {
      Vec3 sum{};
      for (std::size_t k = 0; k < 4; ++k) {
        sum = plus(sum, minus(points[hex[to[k]]], points[hex[from[k]]]));
      }
      return sum;
    };
    return tripleProduct(edges({4, 5, 6, 7}, {0, 1, 2, 3}), edges({1, 2, 5, 6}, {0, 3, 4, 7}),
                         edges({3, 2, 7, 6}, {0, 1, 4, 5}));
  };
  return areMostlyNegative(stage, blockCount(cells.size(), step), volumeOf);
}

void reverse(std::span<Hex> cells, Stage& stage) {
  parallelFor(stage, cells.size(), kOvmCellsGrain,
              [&](std::size_t c) { cells[c] = inHexOrder(cells[c], kReversed); });
}

class HexReader : OvmCellReader<8, kHexOrders> {
 public:
  using OvmCellReader::OvmCellReader;

  HexMesh read() {
    hexes_.points = std::move(mesh_.points);
    readCells();
    if (properties_[OvmInteger::CornerOrder].empty() &&
        isMostlyNegative(hexes_.points, hexes_.cells, stage_)) {
      reverse(hexes_.cells, stage_);
    }
    readGenerators();
    readFeatures(hexes_.features, hexes_.features.quads);
    // The order of edges in the file has no meaning.
    std::vector<FeatureEdge>& edges = hexes_.features.edges;
    for (FeatureEdge& edge : edges) std::sort(edge.vertices.begin(), edge.vertices.end());
    std::sort(edges.begin(), edges.end(),
              [](const FeatureEdge& a, const FeatureEdge& b) { return a.vertices < b.vertices; });
    hexes_.regions = properties_[OvmInteger::Region];
    return std::move(hexes_);
  }

 private:
  void readCells() {
    hexes_.cells.resize(topology_.cells.size());
    const std::size_t fault =
        firstUnreadable([this](std::size_t cell, const QuadLoops& loops, std::size_t order) {
          Hex assembled;
          if (!assembleHex(loops, assembled)) return false;
          hexes_.cells[cell] = inHexOrder(assembled, order);
          return true;
        });
    if (fault < hexes_.cells.size()) failToBound(fault);
  }

  /// Restores generators written by this library. Those of other programs refer to a tet mesh that
  /// is not in the file.
  void readGenerators() {
    const Array<std::int32_t>& tets = properties_[OvmInteger::GeneratorTet];
    const Array<std::int32_t>& corners = properties_[OvmInteger::GeneratorCorners];
    if (tets.empty() || corners.empty()) return;
    hexes_.generatorTet.resize(tets.size());
    hexes_.generatorCorners.resize(tets.size());
    const std::size_t fault = firstFault(stage_, tets.size(), [&](std::size_t v) {
      hexes_.generatorTet[v] = static_cast<Index>(tets[v]);
      hexes_.generatorCorners[v] = static_cast<CornerSet>(corners[v]);
      return tets[v] >= -1 && corners[v] >= 1 && corners[v] <= 15;
    });
    if (fault == tets.size()) return;
    throw Error(ErrorCode::FileSyntax,
                concat(fileName_, ": the generator of vertex ", fault, " is tet ", tets[fault],
                       " with the corner set ", corners[fault], ", which must be from 1 to 15."),
                Place{PlaceKind::Vertex, fault});
  }

  HexMesh hexes_;
};

/// Sets the corner order of cells, which a reader would derive from the start of their first
/// half-faces.
/// @param cells   of the mesh, as the topology was built from them
/// @param turned  whether their corners start alike but run the other way
void setCornerOrder(OvmProperties& properties, const OvmTopology& topology,
                    std::span<const Hex> cells, bool turned, Stage& stage) {
  const auto orderOf = [&](std::size_t c) {
    const std::size_t direction = turned ? kReversed : 0;
    const Index first = topology.cells.handles[6 * c];
    if (first % 2 == 0) return direction;  // starts where its cell does
    const Index begin = topology.from(topology.faces.handles[4 * std::size_t{first / 2}]);
    return (4 - placeIn({cells[c][0], cells[c][1], cells[c][2], cells[c][3]}, begin)) % 4 +
           direction;
  };
  setOvmOrders(properties, cells.size(), orderOf, stage);
}

void setGenerators(OvmProperties& properties, const HexMesh& mesh, Stage& stage) {
  if (mesh.generatorCorners.empty()) return;
  const std::size_t vertices = mesh.points.size();
  Array<std::int32_t>& types = properties[OvmInteger::GeneratorType];
  Array<std::int32_t>& corners = properties[OvmInteger::GeneratorCorners];
  types.resize(vertices);
  corners.resize(vertices);
  Array<std::int32_t>& tets = properties[OvmInteger::GeneratorTet];
  tets.resize(mesh.generatorTet.size());
  std::transform(mesh.generatorTet.begin(), mesh.generatorTet.end(), tets.begin(),
                 [](Index tet) { return static_cast<std::int32_t>(tet); });
  const std::size_t fault = firstFault(stage, vertices, [&](std::size_t v) {
    types[v] = static_cast<std::int32_t>(generatorKind(mesh.generatorCorners[v]));
    corners[v] = mesh.generatorCorners[v];
    return corners[v] >= 1 && corners[v] <= 15;
  });
  if (fault == vertices) return;
  throw Error(ErrorCode::InvalidArgument,
              concat("The generator of vertex ", fault, " has the corner set ", corners[fault],
                     ", which must be from 1 to 15."),
              Place{PlaceKind::Vertex, fault});
}

}  // namespace

Hex inHexOrder(const Hex& assembled, std::size_t order) noexcept {
  Hex hex;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t corner = order < 4 ? (order + i) % 4 : (order - i) % 4;
    hex[i] = assembled[corner];
    hex[i + 4] = assembled[corner + 4];
  }
  return hex;
}

HexMesh toHexMesh(OvmMesh&& mesh, const std::string& fileName, Stage& stage) {
  return HexReader(std::move(mesh), fileName, stage).read();
}

OvmOutput toOvm(const HexMesh& mesh, Stage& stage) {
  const bool turned = isMostlyNegative(mesh.points, mesh.cells, stage);
  Array<Hex> turnedCells;
  if (turned) {
    turnedCells = mesh.cells;
    reverse(turnedCells, stage);
  }
  const std::span<const Hex> cells = turned ? turnedCells : mesh.cells;
  OvmTopology topology = buildOvmTopology(mesh.points.size(), cells, stage);
  OvmProperties properties;
  setCornerOrder(properties, topology, cells, turned, stage);
  setGenerators(properties, mesh, stage);
  setOvmFeatures<4>(properties, topology, mesh.features, mesh.features.quads, mesh.regions);
  return {mesh.points, std::move(topology), std::move(properties).listed()};
}

namespace {

// Maps on tets.

using TetOrder = std::array<std::uint8_t, 4>;

/// All orders of a tet's corners, which the property CornerOrder numbers: corner i of the listed
/// tet is corner kTetOrders[n][i] of the assembled one. Number 0 changes nothing.
constexpr std::array<TetOrder, 24> kTetOrders = {
    {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1},
     {1, 0, 2, 3}, {1, 0, 3, 2}, {1, 2, 0, 3}, {1, 2, 3, 0}, {1, 3, 0, 2}, {1, 3, 2, 0},
     {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3}, {2, 1, 3, 0}, {2, 3, 0, 1}, {2, 3, 1, 0},
     {3, 0, 1, 2}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}, {3, 2, 1, 0}}};
/// If most tets are inverted, two corners of each are swapped.
constexpr std::size_t kAsListed = 0;
constexpr std::size_t kTurned = 2;

/// The three vertices of each half-face, in loop order.
using TriangleLoops = std::array<std::array<Index, 3>, 4>;

/// A cell as assembled: half-face s of its list is opposite corner `opposite[s]`.
struct AssembledTet {
  Tet corners{};
  std::array<std::uint8_t, 4> opposite{};
};

/// Assembles the tet with these four half-faces: the loop of the first one, then the opposite
/// vertex.
/// @return false if they do not bound a tet
bool assembleTet(const TriangleLoops& loops, AssembledTet& tet) {
  const std::array<Index, 3>& base = loops[0];
  const auto inBase = [&](Index v) { return std::find(base.begin(), base.end(), v) != base.end(); };
  const auto* const apex = std::find_if_not(loops[1].begin(), loops[1].end(), inBase);
  if (apex == loops[1].end()) return false;
  tet.corners = {base[0], base[1], base[2], *apex};
  if (hasVertexTwice(tet.corners)) return false;

  unsigned seen = 0;
  for (std::size_t s = 0; s < 4; ++s) {
    const auto inLoop = [&loop = loops[s]](Index v) {
      return std::find(loop.begin(), loop.end(), v) != loop.end();
    };
    const auto opposite = static_cast<std::size_t>(
        std::find_if_not(tet.corners.begin(), tet.corners.end(), inLoop) - tet.corners.begin());
    // All half-faces have the same orientation, seen from inside.
    if (!adjacency::areOpposite(loopOfHalfFace(loops[s], 1),
                                adjacency::faceVertices(tet.corners, opposite)))
      return false;
    tet.opposite[s] = static_cast<std::uint8_t>(opposite);
    seen |= 1U << opposite;
  }
  return seen == 15U;
}

bool isRotation(std::int32_t rotation) { return rotation >= -1 && rotation < 24; }

/// Builds tets from the cells of a mesh, with all data attached to their corners and faces.
class TetReader : OvmCellReader<4, kTetOrders.size()> {
 public:
  using OvmCellReader::OvmCellReader;

  TetMap read() {
    requireMap();
    // With four half-faces per cell, none twice, there are at least 2 faces per cell; otherwise
    // requireProper() throws before memory is allocated.
    if (2 * topology_.cells.size() > topology_.faces.size()) requireProper();
    map_.points.assign(mesh_.points.begin(), mesh_.points.end());
    map_.parameters.resize(topology_.cells.size());
    if (!properties_[OvmInteger::Transition].empty()) map_.rotations.resize(topology_.cells.size());
    readTets();
    requireRotations();
    forEachTag(OvmInteger::EdgeValence, [this](std::size_t e, std::int32_t offset) {
      map_.edgeValences.push_back({topology_.edges[e][0], topology_.edges[e][1], offset});
    });
    readTags(map_);
    return std::move(map_);
  }

  TetCells readWithoutMap() {
    readTets();
    TetCells result;
    result.points = std::move(mesh_.points);
    result.cells.assign(map_.tets.begin(), map_.tets.end());
    readTags(result);
    return result;
  }

 private:
  template <class Mesh>
  void readTags(Mesh& mesh) {
    readFeatures(mesh.features, mesh.features.faces);
    const Array<std::int32_t>& regions = properties_[OvmInteger::Region];
    mesh.regions.assign(regions.begin(), regions.end());
  }

  void requireMap() const {
    if (!properties_.parametrization.empty() || topology_.cells.size() == 0) return;
    requireProper();
    const std::string name = concat("\"", kParametrizationName, "\"");
    throw Error(
        ErrorCode::FileUnsupported,
        concat(fileName_, ": the file holds ", topology_.cells.size(), " tets, but no map: ",
               (mesh_.hasForeignParametrization
                    ? "its property " + name +
                          " is not one of half-faces with three numbers each (3d, vec3d)."
                    : "it has no property " + name + " of half-faces (3d, vec3d)."),
               " Save the map under this name, the value of a half-face being the parameters "
               "of the vertex opposite it in its cell, or save it as .hexex; or give the map as a "
               "second mesh (--polycube)."));
  }

  void readTets() {
    map_.tets.resize(topology_.cells.size());
    const auto read = [this](std::size_t cell, const auto& loops, std::size_t order) {
      return readTet(cell, loops, kTetOrders[order]);
    };
    const std::size_t fault =
        firstUnreadable([&](std::size_t cell, const auto& loops, std::size_t order) {
          return read(cell, loops, order) &&
                 (map_.parameters.empty() || isFinite(map_.parameters[cell]));
        });
    if (fault == map_.tets.size()) return;
    if (!readCell(fault, read)) failToBound(fault);
    throw Error(ErrorCode::NotFinite,
                concat(fileName_, ": a parameter of tet ", fault, " is not finite."),
                Place{PlaceKind::Tet, fault});
  }

  /// Reads a tet with its parameters, and rotations if the map has any.
  bool readTet(std::size_t cell, const TriangleLoops& loops, const TetOrder& order) {
    AssembledTet tet;
    if (!assembleTet(loops, tet)) return false;
    TetOrder place{};  // of each assembled corner in the listed tet
    for (std::uint8_t i = 0; i < 4; ++i) {
      place[order[i]] = i;
      map_.tets[cell][i] = tet.corners[order[i]];
    }
    for (std::size_t s = 0; s < 4; ++s) {
      const Index halfFace = topology_.cells[cell][s];
      const std::size_t corner = place[tet.opposite[s]];
      if (!map_.parameters.empty()) {
        map_.parameters[cell][corner] = properties_.parametrization[halfFace];
      }
      if (map_.rotations.empty()) continue;
      const std::int32_t rotation = properties_[OvmInteger::Transition][halfFace];
      map_.rotations[cell][corner] = static_cast<std::int8_t>(isRotation(rotation) ? rotation : -1);
    }
    return true;
  }

  /// Refuses values beyond the 24 rotations, except at the boundary, where they have no meaning.
  void requireRotations() const {
    const Array<std::int32_t>& rotations = properties_[OvmInteger::Transition];
    if (std::all_of(rotations.begin(), rotations.end(), isRotation)) return;
    Array<char> used(rotations.size(), 0);
    for (const Index halfFace : topology_.cells.handles) used[halfFace] = 1;
    for (std::size_t i = 0; i < topology_.cells.handles.size(); ++i) {
      const Index halfFace = topology_.cells.handles[i];
      if (isRotation(rotations[halfFace]) || used[halfFace ^ 1U] == 0) continue;
      throw Error(ErrorCode::FileSyntax,
                  concat(fileName_, ": the rotation across half-face ", halfFace, " of tet ", i / 4,
                         " is ", rotations[halfFace],
                         ", but rotations are numbered from 0 to 23, or -1 if unknown."),
                  Place{PlaceKind::Tet, i / 4});
    }
  }

  TetMap map_;
};

/// The number of the corner order in which to write tets.
std::size_t writtenOrder(std::span<const Vec3> points, std::span<const Tet> tets, Stage& stage) {
  const auto volumeOf = [&](std::size_t t) {
    const Vec3& origin = points[tets[t][0]];
    return tripleProduct(minus(points[tets[t][3]], origin), minus(points[tets[t][1]], origin),
                         minus(points[tets[t][2]], origin));
  };
  return areMostlyNegative(stage, tets.size(), volumeOf) ? kTurned : kAsListed;
}

OvmTopology topologyOf(std::size_t points, std::span<const Tet> tets, const TetOrder& order,
                       Stage& stage) {
  Array<Tet> ordered(tets.size());
  parallelFor(stage, tets.size(), kOvmCellsGrain, [&](std::size_t t) {
    for (std::size_t i = 0; i < 4; ++i) ordered[t][i] = tets[t][order[i]];
  });
  return buildOvmTopology(points, ordered, stage);
}

/// Builds a mesh from a map.
class TetWriter {
 public:
  TetWriter(const TetMap& map, Stage& stage)
      : map_(map),
        stage_(stage),
        orderNumber_(writtenOrder(map.points, map.tets, stage)),
        order_(kTetOrders[orderNumber_]),
        topology_(topologyOf(map.points.size(), map.tets, order_, stage)) {}

  OvmOutput write() {
    setOvmOrders(
        properties_, map_.tets.size(), [this](std::size_t t) { return listedOrder(t); }, stage_);
    setHalfFaceValues();
    setEdgeValences();
    setOvmFeatures<3>(properties_, topology_, map_.features, map_.features.faces, map_.regions);
    return {map_.points, std::move(topology_), std::move(properties_).listed()};
  }

 private:
  /// The corner order of a tet, relative to the order that a reader derives.
  [[nodiscard]] std::size_t listedOrder(std::size_t tet) const {
    // A tet starts with its first half-face, and nearly all half-faces start where the tet does.
    const Index first = topology_.cells.handles[4 * tet];
    if (first % 2 == 0) return orderNumber_;
    const std::array<Index, 3> loop = loopOfHalfFace(loopOfFace<3>(topology_, first / 2), first);
    const Tet& listed = map_.tets[tet];
    const Tet assembled = {loop[0], loop[1], loop[2], listed[order_[3]]};
    const auto* const found =
        std::find_if(kTetOrders.begin(), kTetOrders.end(), [&](const TetOrder& order) {
          return listed == Tet{assembled[order[0]], assembled[order[1]], assembled[order[2]],
                               assembled[order[3]]};
        });
    return static_cast<std::size_t>(found - kTetOrders.begin());
  }

  /// Sets parameters and rotations, which half-faces store for their opposite corners.
  void setHalfFaceValues() {
    Array<Vec3>& parameters = properties_.parametrization;
    Array<std::int32_t>& rotations = properties_[OvmInteger::Transition];
    // Boundary half-faces have no cell; all others are overwritten.
    parameters.assign(2 * topology_.faces.size(), Vec3{});
    if (!map_.rotations.empty()) rotations.assign(parameters.size(), -1);
    parallelFor(stage_, map_.tets.size(), kOvmCellsGrain, [&](std::size_t t) {
      for (std::size_t s = 0; s < 4; ++s) {
        const Index halfFace = topology_.cells.handles[4 * t + s];
        const std::size_t corner = order_[kOvmTetOpposite[s]];
        parameters[halfFace] = map_.parameters[t][corner];
        if (rotations.empty()) continue;
        const std::int8_t rotation = map_.rotations[t][corner];
        rotations[halfFace] = isRotation(rotation) ? rotation : -1;
      }
    });
  }

  void setEdgeValences() {
    if (map_.edgeValences.empty()) return;
    Array<std::int32_t>& offsets = properties_[OvmInteger::EdgeValence];
    offsets.assign(topology_.edges.size(), 0);
    const OvmEdgeFinder finder(topology_.vertexCount, topology_.edges);
    for (const EdgeValence& edge : map_.edgeValences) {
      const Place place{PlaceKind::Edge, edge.vertex0, edge.vertex1};
      setOvmValue(offsets, finder.find(edge.vertex0, edge.vertex1), edge.offset,
                  toString(place) + " with a known valence", place);
    }
  }

  const TetMap& map_;
  Stage& stage_;
  std::size_t orderNumber_;
  const TetOrder& order_;
  OvmTopology topology_;
  OvmProperties properties_;
};

}  // namespace

TetMap toTetMap(OvmMesh&& mesh, const std::string& fileName, Stage& stage) {
  return TetReader(std::move(mesh), fileName, stage).read();
}

TetCells toTetCells(OvmMesh&& mesh, const std::string& fileName, Stage& stage) {
  return TetReader(std::move(mesh), fileName, stage).readWithoutMap();
}

OvmOutput toOvm(const TetMap& map, Stage& stage) {
  requireWritable(map, stage);
  return TetWriter(map, stage).write();
}

OvmTopology ovmTopologyOf(std::span<const Vec3> points, std::span<const Tet> tets, Stage& stage) {
  return topologyOf(points.size(), tets, kTetOrders[writtenOrder(points, tets, stage)], stage);
}

}  // namespace hexhex::io
