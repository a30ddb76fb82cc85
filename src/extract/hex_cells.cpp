#include <algorithm>
#include <vector>

#include <extract/hex_cells.hpp>
#include <extract/link_corners.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

class CellWalker {
 public:
  CellWalker(const HexVertices& vertices, const LocalConnectivity& local,
             const GlobalConnectivity& global)
      : vertices_(vertices), local_(local), global_(global) {}

  /// Appends the cells whose first corner is at this vertex.
  void run(Index vertex, std::vector<Hex>& cells) const {
    const Configuration& configuration = configurationAt(vertex);
    for (std::uint16_t c = 0; c < configuration.cornerCount; ++c) {
      const HexCorner& corner = local_.corners[configuration.cornerBegin + c];
      Hex cell;
      if (walk({vertex, {corner.propeller, corner.slot}}, c, cell)) cells.push_back(cell);
    }
  }

 private:
  /// A hex corner at a vertex, seen from one of its three propellers.
  struct At {
    Index vertex;
    SlotName slot;
  };

  [[nodiscard]] const Configuration& configurationAt(Index vertex) const {
    return local_.configuration(vertices_.generatorOf[vertex]);
  }

  /// The same hex corner seen from the next of its propellers.
  [[nodiscard]] At rotate(const At& at) const {
    const Propeller* propellers =
        local_.propellers.data() + configurationAt(at.vertex).propellerBegin;
    return {at.vertex, rotateCorner(propellers, local_.slots.data(), at.slot)};
  }

  /// Along the propeller to the corner of the same cell at its other end: the corner between blades
  /// i and i + 1 becomes the one between offset - i - 1 and offset - i.
  [[nodiscard]] At across(const At& at) const {
    const Index generator = vertices_.generatorOf[at.vertex];
    const Configuration& configuration = local_.configuration(generator);
    const std::uint64_t rank = at.vertex - vertices_.generators[generator].firstVertex;
    const Opposite opposite = GlobalConnectivity::unpack(
        global_.opposites[global_.begin[generator] + rank * configuration.propellerCount +
                          at.slot.propeller]);
    const std::size_t count = local_.propeller(configuration, at.slot.propeller).slotCount;
    return {opposite.vertex,
            {opposite.propeller, (opposite.offset + 2 * count - at.slot.slot - 1) % count}};
  }

  /// Whether the cell's corner at `at` comes after its corner number `corner` at vertex `first`.
  [[nodiscard]] bool comesAfter(const At& at, Index first, std::uint16_t corner) const {
    if (at.vertex != first) return at.vertex > first;
    const Propeller& propeller = local_.propeller(configurationAt(first), at.slot.propeller);
    return local_.slot(propeller, at.slot.slot).corner > corner;
  }

  /// Collects the cell's vertices; false, early, if this corner is not the cell's first one.
  ///
  /// The corner's propellers x, y, z become the cell's axes. Moving along one of them swaps the
  /// order of the other two, so after a move along x the corner is seen from x with z before y.
  bool walk(const At& v0, std::uint16_t corner, Hex& cell) const {
    const auto visit = [&](std::size_t i, const At& at) {
      cell[i] = at.vertex;
      return comesAfter(at, v0.vertex, corner);
    };
    cell[0] = v0.vertex;
    const At v1 = across(v0);  // (x; z, y)
    if (!visit(1, v1)) return false;
    const At alongY = rotate(v0);  // (y; z, x)
    const At v3 = across(alongY);  // (y; x, z)
    if (!visit(3, v3)) return false;
    const At v4 = across(rotate(alongY));  // (z; y, x)
    if (!visit(4, v4)) return false;
    const At v1AlongZ = rotate(v1);          // (z; y, x)
    const At v2 = across(rotate(v1AlongZ));  // along y: (y; z, x)
    if (!visit(2, v2)) return false;
    if (!visit(5, across(v1AlongZ))) return false;
    if (!visit(6, across(rotate(v2)))) return false;  // along z
    return visit(7, across(rotate(rotate(v3))));      // along z
  }

  const HexVertices& vertices_;
  const LocalConnectivity& local_;
  const GlobalConnectivity& global_;
};

}  // namespace

std::uint64_t countCells(const HexVertices& vertices, const LocalConnectivity& local) {
  std::uint64_t corners = 0;
  for (std::size_t g = 0; g < vertices.generators.size(); ++g) {
    corners += std::uint64_t{vertices.generators[g].vertexCount} *
               local.configuration(static_cast<Index>(g)).cornerCount;
  }
  return corners / 8;
}

Array<Hex> collectCells(const HexVertices& vertices, const LocalConnectivity& local,
                        const GlobalConnectivity& global, Stage& stage) {
  const std::size_t vertexCount = vertices.positions.size();
  std::vector<std::vector<Hex>> blocks(blockCount(vertexCount, kGrain));
  const CellWalker walker(vertices, local, global);
  parallelBlocks(stage, vertexCount, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   blocks[block].reserve(end - begin);  // about one cell per vertex
                   for (std::size_t v = begin; v < end; ++v) {
                     walker.run(static_cast<Index>(v), blocks[block]);
                   }
                 });
  std::vector<std::size_t> offsets(blocks.size() + 1, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) offsets[b + 1] = offsets[b] + blocks[b].size();
  Array<Hex> cells(offsets.back());
  parallelFor(stage, blocks.size(), 1, [&](std::size_t b) {
    std::copy(blocks[b].begin(), blocks[b].end(),
              cells.begin() + static_cast<std::ptrdiff_t>(offsets[b]));
    std::vector<Hex>().swap(blocks[b]);
  });
  return cells;
}

}  // namespace hexhex
