#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

#include <atlas/atlas.hpp>
#include <atlas/cell_emitter.hpp>
#include <atlas/charts.hpp>
#include <atlas/cut_marks.hpp>
#include <atlas/vertex_grid.hpp>

namespace hexhex {

namespace {

/// More vertices than this need wide ids: two values are reserved.
constexpr std::uint64_t kMaxNarrowVertices = std::numeric_limits<std::uint32_t>::max() - 1;

void requireExpected(std::uint64_t cells, std::uint64_t expected) {
  if (cells == expected) return;
  throw Error(ErrorCode::Internal,
              "The map's parametric volume is " + std::to_string(expected) + ", but " +
                  std::to_string(cells) +
                  " cell centres were found. This is a bug; please report it with the map.");
}

/// The stages up to a complete grid of vertices.
template <class Id>
class Atlas {
 public:
  Atlas(const PreparedMap& map, bool keepLines, Context& context)
      : map_(map), vertices_(map, charts_, keepLines), context_(context) {
    Stage stage(context, "charts");
    charts_ = buildCharts(map, stage);
  }

  /// @return the number of vertices
  std::uint64_t sweep() {
    Stage stage(context_, "vertices");
    vertices_.sweep(stage);
    return vertices_.numbers().count();
  }

  void fill(const VertexArrays& arrays, ExtractStatistics& statistics) {
    {
      Stage stage(context_, "grid");
      vertices_.fill(arrays, stage);
    }
    {
      Stage stage(context_, "overlaps");
      const OverlapCounts overlaps = vertices_.resolveOverlaps(stage);
      statistics.overlappingTets = overlaps.tets;
    }
    Stage stage(context_, "cuts");
    crossings_ = markCutCells(map_, charts_, vertices_.grid(), stage);
    statistics.cutFaces = crossings_.cutFaces;
    vertices_.dropLines();
    statistics.charts = charts_.count;
    statistics.generators = vertices_.numbers().generatorCounts;
    statistics.vertices = vertices_.numbers().vertexCounts;
  }

  [[nodiscard]] const VertexGrid<Id>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] const Crossings& crossings() const noexcept { return crossings_; }

 private:
  const PreparedMap& map_;
  Charts charts_;
  VertexGrid<Id> vertices_;
  Crossings crossings_;
  Context& context_;
};

/// All cells at once.
Array<Hex> emitCells(const PreparedMap& map, const Atlas<Index>& atlas, std::uint64_t expectedCells,
                     Context& context, ExtractStatistics& statistics) {
  TetLines lines(map.topology.tetCount());
  Array<std::uint64_t> begin;
  {
    Stage stage(context, "centers");
    begin = numberCells(map, lines, stage);
    requireExpected(begin.back(), expectedCells);
  }
  Stage stage(context, "cells");
  Array<Hex> cells(begin.back());
  std::atomic<std::uint64_t> traced{0};
  parallelBlocks(stage, map.topology.tetCount(), kSweepBlock,
                 [&](std::size_t first, std::size_t end, std::size_t) {
                   if (begin[first] == begin[end]) return;
                   CellEmitter<Index> emitter(map, atlas.vertices(), atlas.crossings());
                   for (std::size_t t = first; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     emitter.emit(tet, lines.of(tet),
                                  std::span(cells).subspan(begin[t], begin[t + 1] - begin[t]));
                   }
                   traced.fetch_add(emitter.traced(), std::memory_order_relaxed);
                 });
  statistics.tracedCells = traced.load();
  return cells;
}

}  // namespace

HexMesh runAtlas(const PreparedMap& map, std::uint64_t expectedCells, Context& context,
                 ExtractStatistics& statistics) {
  Atlas<Index> atlas(map, true, context);
  const std::uint64_t count = atlas.sweep();
  if (count > kMaxNarrowVertices) {
    throw Error(ErrorCode::TooLarge,
                "The mesh would have " + std::to_string(count) +
                    " vertices, more than 32-bit indices can number. Lower the scale, or extract "
                    "piece by piece.");
  }
  HexMesh mesh;
  mesh.points.resize(count);
  mesh.generatorTet.resize(count);
  mesh.generatorCorners.resize(count);
  atlas.fill({0, mesh.points.data(), mesh.generatorTet.data(), mesh.generatorCorners.data()},
             statistics);
  mesh.cells = emitCells(map, atlas, expectedCells, context, statistics);
  return mesh;
}

}  // namespace hexhex
