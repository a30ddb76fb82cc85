// Hex meshes from and to polyhedral meshes (see ovm_cells.hpp).
#include <algorithm>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <io/formats/ovm_cells.hpp>

namespace hexhex::io {

namespace {

constexpr std::size_t kOvmHexesGrain = 4096;
constexpr std::size_t kReversed = 4;  // the order of a cell that begins alike but turns round

using QuadLoops = std::array<std::array<Index, 4>, 6>;

/// Where a vertex stands in a loop, or 4.
std::size_t placeIn(const std::array<Index, 4>& loop, Index vertex) {
  return static_cast<std::size_t>(std::find(loop.begin(), loop.end(), vertex) - loop.begin());
}

/// Where side i of the base begins in the loop of a face that passes it in the other direction; or
/// 4, also if the face shares more with the base.
std::size_t sideOfBase(const std::array<Index, 4>& base, const std::array<Index, 4>& loop) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t place = placeIn(loop, base[(i + 1) % 4]);
    if (place < 4 && loop[(place + 1) % 4] == base[i]) return i;
  }
  return 4;
}

/// The hexahedron with the six half-faces in VTK's order: the loop of the first one, then the
/// vertices that edges join to them. Positive if loops run counter-clockwise seen from inside.
/// @return false if they do not bound a hexahedron
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
  // The lid passes the vertices above the base in the other direction.
  const std::size_t start = placeIn(loops[lid], top[3]);
  if (start == 4) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    if (loops[lid][(start + i) % 4] != top[3 - i]) return false;
  }
  return true;
}

/// Whether most hexahedra have a negative volume (that of their mean edge vectors). Of a large
/// mesh, some tens of thousands are asked: positions are far from each other in memory.
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
  parallelFor(stage, cells.size(), kOvmHexesGrain,
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
    // The numbering of edges says nothing.
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

  /// Restores generators that this library wrote. Those of other programs name entities of a tet
  /// mesh that is not here.
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
                fileName_ + ": the generator of vertex " + std::to_string(fault) + " is tet " +
                    std::to_string(tets[fault]) + " with the corner set " +
                    std::to_string(corners[fault]) + ", which must be from 1 to 15.",
                Place{PlaceKind::Vertex, fault});
  }

  HexMesh hexes_;
};

/// Tells how cells are listed, which a reader finds from where their first half-faces begin.
/// @param cells   those of the mesh as the topology was built from them
/// @param turned  whether they begin alike but turn the other way
void setCornerOrder(OvmProperties& properties, const OvmTopology& topology,
                    std::span<const Hex> cells, bool turned, Stage& stage) {
  const auto orderOf = [&](std::size_t c) {
    const std::size_t direction = turned ? kReversed : 0;
    const Index first = topology.cells.handles[6 * c];
    if (first % 2 == 0) return direction;  // begins where its cell does
    const Index begin = topology.from(topology.faces.handles[4 * std::size_t{first / 2}]);
    return (4 - placeIn({cells[c][0], cells[c][1], cells[c][2], cells[c][3]}, begin)) % 4 +
           direction;
  };
  Array<std::int32_t> orders(cells.size());
  const std::size_t unlike = firstFault(stage, cells.size(), [&](std::size_t c) {
    orders[c] = static_cast<std::int32_t>(orderOf(c));
    return orders[c] == 0;
  });
  if (unlike < cells.size()) properties[OvmInteger::CornerOrder] = std::move(orders);
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
              "The generator of vertex " + std::to_string(fault) + " has the corner set " +
                  std::to_string(corners[fault]) + ", which must be from 1 to 15.",
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

}  // namespace hexhex::io
