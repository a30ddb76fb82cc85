// The canonical numbers of hex edges and hex faces: ordered by the tet that owns the midpoint (the
// smallest tet that contains it), then by axis (along an edge, across a face), then in the order of
// the tet's sweep over midpoints. They need no mesh topology, and they distinguish two edges
// between the same two vertices.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <lattice/tet_rasterizer.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex::curved {

enum class ElementKind : std::uint8_t { Edges, Faces };

/// One element as seen from the owner of its midpoint.
struct Element {
  std::uint64_t number;
  int axis;                     ///< of the owner's chart: along an edge, across a face
  lattice::GridPoint z;         ///< smallest corner
  lattice::CornerMask simplex;  ///< of the owner; holds the midpoint
};

class ElementNumbers {
 private:
  struct Line {
    lattice::SweptLine swept;
    std::uint32_t ownedFirst;
    std::uint32_t ownedCount;
    Index number;  ///< of the first owned one
  };

 public:
  /// @throws Error TooLarge for more elements than an Index can number
  ElementNumbers(const igm::PreparedMap& map, ElementKind kind, Stage& stage);
  /// Contains no elements yet: call add() and finish().
  ElementNumbers(const igm::PreparedMap& map, ElementKind kind);

  /// The grid of the midpoints of edges along an axis, or of faces across it.
  [[nodiscard]] static constexpr lattice::HalfGrid midpointsOf(ElementKind kind,
                                                               int axis) noexcept {
    const int along = 1 << axis;
    return static_cast<lattice::HalfGrid>(kind == ElementKind::Edges ? along : 7 ^ along);
  }

  // To number elements while something else sweeps the same tets:
  /// Call for the tets of each block of kSweepBlock in order; blocks in any order and in parallel.
  void add(std::size_t block, Index tet, lattice::TetRasterizer& rasterizer);
  /// Call when all tets have been added.
  /// @throws Error TooLarge for more elements than an Index can number
  void finish(Stage& stage);

  [[nodiscard]] std::uint64_t count() const noexcept { return begin_.back(); }
  /// The first element that a tet owns; also defined for the tet past the last.
  [[nodiscard]] std::uint64_t begin(std::size_t tet) const noexcept { return begin_[tet]; }

  /// Visits all elements that a tet owns, in order.
  template <class Visit>
  void forEach(Index tet, const Visit& visit) const {
    std::uint64_t number = begin_[tet];
    if (number == begin_[std::size_t{tet} + 1]) return;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Line& line : linesOf(tet, axis)) {
        for (std::uint32_t i = line.ownedFirst; i < line.ownedFirst + line.ownedCount; ++i) {
          visit(Element{number++, axis, line.swept.point(i), line.swept.simplex(i)});
        }
      }
    }
  }

  /// The number of an element, given its owner.
  /// @param hint  moves along; use one for each of several simultaneous searches
  /// @throws Error Internal if the tet does not own it
  [[nodiscard]] Index find(Index owner, int axis, const lattice::GridPoint& z,
                           std::size_t& hint) const;

 private:
  [[nodiscard]] static std::size_t gridOf(Index tet, int axis) noexcept {
    return 3 * std::size_t{tet} + static_cast<std::size_t>(axis);
  }
  [[nodiscard]] std::span<const Line> linesOf(Index tet, int axis) const noexcept {
    const std::size_t grid = gridOf(tet, axis);
    const std::size_t block = tet / sweep::kSweepBlock;
    const Index blockBegin = lineBegin_[3 * sweep::kSweepBlock * block];
    return std::span(blocks_[block])
        .subspan(lineBegin_[grid] - blockBegin, lineBegin_[grid + 1] - lineBegin_[grid]);
  }
  const adjacency::TetTopology& topology_;
  ElementKind kind_;
  Array<std::uint64_t> begin_;  ///< per tet (+1)
  Array<Index> lineBegin_;      ///< per tet and axis (+1); there are no more lines than elements
  std::vector<Array<Line>> blocks_;  ///< per block of tets: lines with owned elements
};

/// @throws Error TooLarge for more elements than an Index can number
void requireNumbers(std::uint64_t elements);

/// Vertices and edges, numbered in a single sweep over the tets.
struct GridNumbers {
  sweep::VertexTables vertices;
  ElementNumbers edges;
};

/// Numbers edges while the atlas engine sweeps the tets for vertices and cells.
class EdgeObserver final : public sweep::SweepObserver {
 public:
  explicit EdgeObserver(const igm::PreparedMap& map) : map_(map), edges_(map, ElementKind::Edges) {}

  void add(std::size_t block, Index tet, lattice::TetRasterizer& rasterizer) override {
    edges_.add(block, tet, rasterizer);
  }
  void take(sweep::SweptVertices vertices) override { vertices_ = std::move(vertices); }

  /// Call once, after the engine has finished.
  /// @throws Error TooLarge for more than an Index can number
  [[nodiscard]] GridNumbers finish(Stage& stage);

 private:
  const igm::PreparedMap& map_;
  ElementNumbers edges_;
  std::optional<sweep::SweptVertices> vertices_;
};

/// Numbers both without an engine.
/// @throws Error TooLarge for more than an Index can number
[[nodiscard]] GridNumbers numberVerticesAndEdges(const igm::PreparedMap& map, Stage& stage);

}  // namespace hexhex::curved
