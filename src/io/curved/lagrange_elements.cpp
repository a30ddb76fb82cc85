#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <utility>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/curved/lagrange_elements.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 12;

// A place is 16 * cell + slot: a cell has 12 edges and 6 faces.
constexpr std::uint64_t kSlots = 16;

template <std::size_t n>
std::array<Index, n> sorted(std::array<Index, n> vertices) {
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

template <std::size_t n>
std::array<Index, n> verticesAt(const Hex& cell, const std::array<std::uint8_t, n>& corners) {
  std::array<Index, n> vertices;
  for (std::size_t i = 0; i < n; ++i) vertices[i] = cell[corners[i]];
  return vertices;
}

/// Finds elements, which are few, in the cells that have them.
template <std::size_t n>
class ElementFinder {
 public:
  ElementFinder(const HexMesh& mesh, std::span<const std::array<Index, n>> elements)
      : mesh_(mesh), marked_(mesh.points.size(), 0), places_(elements.size(), kNoPlace) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      wanted_.emplace_back(sorted(elements[i]), i);
      for (const Index vertex : elements[i]) marked_[vertex] = 1;
    }
    std::sort(wanted_.begin(), wanted_.end());
  }

  /// The first place of each element, or kNoPlace.
  /// @param corners  of the elements of a cell, by slot
  template <std::size_t slots>
  std::vector<std::uint64_t> find(const std::array<std::array<std::uint8_t, n>, slots>& corners,
                                  Stage& stage) {
    static_assert(slots <= kSlots);
    if (wanted_.empty()) return std::move(places_);
    parallelFor(stage, mesh_.cells.size(), kGrain, [&](std::size_t c) {
      const Hex& cell = mesh_.cells[c];
      const auto count = std::count_if(cell.begin(), cell.end(),
                                       [this](Index vertex) { return marked_[vertex] != 0; });
      if (static_cast<std::size_t>(count) < n) return;
      for (std::size_t slot = 0; slot < slots; ++slot) {
        offer(sorted(verticesAt(cell, corners[slot])), kSlots * c + slot);
      }
    });
    return std::move(places_);
  }

 private:
  using Wanted = std::pair<std::array<Index, n>, std::size_t>;

  void offer(const std::array<Index, n>& vertices, std::uint64_t place) {
    for (auto found = std::lower_bound(wanted_.begin(), wanted_.end(), Wanted{vertices, 0});
         found != wanted_.end() && found->first == vertices; ++found) {
      const std::atomic_ref known(places_[found->second]);
      std::uint64_t before = known.load(std::memory_order_relaxed);
      while (place < before && !known.compare_exchange_weak(before, place)) {
      }
    }
  }

  const HexMesh& mesh_;
  std::vector<std::uint8_t> marked_;  ///< per vertex: whether a wanted element has it
  std::vector<Wanted> wanted_;        ///< by their vertices
  std::vector<std::uint64_t> places_;
};

[[noreturn]] void failAbout(const char* what, std::span<const Index> vertices) {
  std::string text = std::string("The tagged ") + what;
  for (const Index vertex : vertices) text.append(1, ' ').append(std::to_string(vertex));
  throw Error(ErrorCode::InvalidArgument, text + " belongs to no cell of the mesh.");
}

/// Where a cell has the nodes of its corners, and the steps between nodes.
class CellNodes {
 public:
  explicit CellNodes(int order) {
    const std::ptrdiff_t row = order + 1;
    steps_ = {1, row, row * row};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const bool x = corner % 4 == 1 || corner % 4 == 2;
      const bool y = corner % 4 >= 2;
      const bool z = corner >= 4;
      at_[corner] = order * ((x ? steps_[0] : 0) + (y ? steps_[1] : 0) + (z ? steps_[2] : 0));
    }
    order_ = order;
  }
  [[nodiscard]] std::ptrdiff_t corner(std::size_t i) const { return at_[i]; }
  /// From a corner towards another one, at the same edge.
  [[nodiscard]] std::ptrdiff_t step(std::size_t from, std::size_t to) const {
    return (at_[to] - at_[from]) / order_;
  }

 private:
  std::ptrdiff_t order_;
  std::array<std::ptrdiff_t, 3> steps_{};
  std::array<std::ptrdiff_t, 8> at_{};
};

/// Appends the nodes from + i * stepI + j * stepJ of a cell, where i + (p + 1) j are the entries of
/// an order.
void appendNodes(const LagrangeMesh& mesh, std::uint64_t cell, std::ptrdiff_t from,
                 std::ptrdiff_t stepI, std::ptrdiff_t stepJ,
                 std::span<const std::uint32_t> nodeOrder, Array<Index>& nodes) {
  const Index* const ofCell = mesh.nodes.data() + cell * mesh.nodesPerCell();
  const std::ptrdiff_t row = mesh.order + 1;
  for (const std::uint32_t entry : nodeOrder) {
    const auto at = static_cast<std::ptrdiff_t>(entry);
    nodes.push_back(ofCell[from + at % row * stepI + at / row * stepJ]);
  }
}

}  // namespace

Array<Index> edgeNodes(const LagrangeMesh& mesh, const HexMesh& straight, const EdgeGroups& edges,
                       std::span<const std::uint32_t> nodeOrder, Stage& stage) {
  const std::vector<std::uint64_t> places =
      ElementFinder<2>(straight, edges.elements).find(kHexEdges, stage);
  const CellNodes cellNodes(mesh.order);
  Array<Index> nodes;
  nodes.reserve(places.size() * nodeOrder.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] == kNoPlace) failAbout("edge", edges.elements[i]);
    const std::uint64_t cell = places[i] / kSlots;
    auto [a, b] = kHexEdges[places[i] % kSlots];
    if (straight.cells[cell][a] != edges.elements[i][0]) std::swap(a, b);
    appendNodes(mesh, cell, cellNodes.corner(a), cellNodes.step(a, b), 0, nodeOrder, nodes);
  }
  return nodes;
}

Array<Index> quadNodes(const LagrangeMesh& mesh, const HexMesh& straight, const QuadGroups& quads,
                       std::span<const std::uint32_t> nodeOrder, Stage& stage) {
  std::vector<Quad> inside;
  for (std::size_t i = 0; i < quads.elements.size(); ++i) {
    if (quads.places[i] == kNoPlace) inside.push_back(quads.elements[i]);
  }
  const std::vector<std::uint64_t> found =
      ElementFinder<4>(straight, inside).find(kHexFaces, stage);
  const CellNodes cellNodes(mesh.order);
  Array<Index> nodes;
  nodes.reserve(quads.elements.size() * nodeOrder.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < quads.elements.size(); ++i) {
    std::uint64_t cell = quads.places[i] / 8;
    std::uint64_t face = quads.places[i] % 8;
    if (quads.places[i] == kNoPlace) {
      if (found[next] == kNoPlace) failAbout("quad", quads.elements[i]);
      cell = found[next] / kSlots;
      face = found[next++] % kSlots;
    }
    const auto& [a, b, c, d] = kHexFaces[face];
    appendNodes(mesh, cell, cellNodes.corner(a), cellNodes.step(a, b), cellNodes.step(a, d),
                nodeOrder, nodes);
  }
  return nodes;
}

}  // namespace hexhex
