#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <atlas/atlas.hpp>
#include <atlas/cell_emitter.hpp>
#include <atlas/charts.hpp>
#include <atlas/cut_marks.hpp>
#include <atlas/vertex_grid.hpp>
#include <base/workspaces.hpp>

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
  Atlas(const PreparedMap& map, bool keepLines, Context& context, const EngineSwitches& switches)
      : map_(map),
        vertices_(map, charts_, keepLines),
        cells_(map.topology.tetCount(), keepLines),
        context_(context),
        switches_(switches) {
    Stage stage(context, "charts");
    charts_ = buildCharts(map, stage);
  }

  /// @param observer  sees every tet, if there is one
  /// @return the number of vertices
  std::uint64_t sweep(std::uint64_t expectedCells, SweepObserver* observer = nullptr) {
    Stage stage(context_, "sweep");
    vertices_.sweep(cells_, stage, observer);
    requireExpected(cells_.count(), expectedCells);
    return vertices_.numbers().count();
  }

  /// @param keepLines  for takeVertices()
  void fill(const VertexArrays& arrays, bool keepLines, ExtractStatistics& statistics) {
    {
      Stage stage(context_, "grid");
      vertices_.fill(arrays, stage);
    }
    OverlapCounts overlaps;
    {
      Stage stage(context_, "overlaps");
      if (switches_.resolveOverlaps) overlaps = vertices_.resolveOverlaps(stage);
    }
    statistics.overlappingTets = overlaps.tets;
    Stage stage(context_, "cuts");
    if (switches_.markCuts) {
      const bool onlyJumps = overlaps.tets == 0 && charts_.identitiesAgree;
      Cuts cuts = markCutCells(map_, charts_, onlyJumps, vertices_.grid(), stage);
      statistics.cutFaces = cuts.faces;
      jumps_ = std::move(cuts.jumps);
    }
    if (!keepLines) vertices_.dropLines();
    statistics.charts = charts_.count;
    statistics.generators = vertices_.numbers().generatorCounts;
    statistics.vertices = vertices_.numbers().vertexCounts;
  }

  [[nodiscard]] const VertexGrid<Id>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] SweptVertices takeVertices() noexcept { return vertices_.takeVertices(); }
  [[nodiscard]] const CellSeeds& cells() const noexcept { return cells_; }
  [[nodiscard]] const Jumps& jumps() const noexcept { return jumps_; }

 private:
  const PreparedMap& map_;
  Charts charts_;
  VertexGrid<Id> vertices_;
  CellSeeds cells_;
  Jumps jumps_;
  Context& context_;
  EngineSwitches switches_;
};

/// Emits cells by as many emitters as work at the same time; they remember much of what they saw.
template <class Id>
class CellEmitters {
 public:
  CellEmitters(const PreparedMap& map, const Atlas<Id>& atlas) : map_(map), atlas_(atlas) {}

  /// Emits the cells of consecutive tets.
  /// @param first  number of the first cell in `cells`
  void emit(std::size_t firstTet, std::size_t endTet, std::uint64_t first,
            std::span<typename CellEmitter<Id>::Cell> cells) {
    const Array<std::uint64_t>& begin = atlas_.cells().begin;
    if (begin[firstTet] == begin[endTet]) return;
    const auto make = [this] {
      return Workspace{CellEmitter<Id>(map_, atlas_.vertices(), atlas_.jumps()), {}};
    };
    workspaces_.with(make, [&](Workspace& workspace) {
      auto& [emitter, lines] = workspace;
      for (std::size_t t = firstTet; t < endTet; ++t) {
        if (begin[t] == begin[t + 1]) continue;
        const auto tet = static_cast<Index>(t);
        emitter.emit(tet, atlas_.cells().linesOf(map_.exact, tet, lines),
                     cells.subspan(begin[t] - first, begin[t + 1] - begin[t]));
      }
    });
  }

  /// Cells so far with a corner that the picture hides. Not while others emit.
  [[nodiscard]] std::uint64_t traced() const {
    std::uint64_t sum = 0;
    workspaces_.forEach([&sum](const Workspace& each) { sum += each.emitter.traced(); });
    return sum;
  }

 private:
  struct Workspace {
    CellEmitter<Id> emitter;
    std::vector<SweptLine> lines;  ///< of a tet, where they are not kept
  };

  const PreparedMap& map_;
  const Atlas<Id>& atlas_;
  Workspaces<Workspace> workspaces_;
};

/// All cells at once.
Array<Hex> emitAllCells(const PreparedMap& map, const Atlas<Index>& atlas, Context& context,
                        ExtractStatistics& statistics) {
  Stage stage(context, "cells");
  Array<Hex> cells(atlas.cells().count());
  CellEmitters<Index> emitters(map, atlas);
  parallelBlocks(stage, map.topology.tetCount(), kSweepBlock,
                 [&](std::size_t first, std::size_t end, std::size_t) {
                   emitters.emit(first, end, 0, std::span(cells));
                 });
  statistics.tracedCells = emitters.traced();
  return cells;
}

/// Consecutive tets that own about as many elements as a piece should have.
struct Batch {
  std::size_t firstTet;
  std::size_t endTet;
};

Batch nextBatch(const Array<std::uint64_t>& begin, std::size_t firstTet) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  std::size_t end = firstTet + 1;
  const std::size_t tets = begin.size() - 1;
  while (end < tets && begin[end + 1] - begin[firstTet] <= kPiece) ++end;
  return {firstTet, end};
}

/// Tets of a batch that one thread works on at a time.
constexpr std::size_t kBatchGrain = 64;

template <class Id>
void streamPoints(const PreparedMap& map, const VertexGrid<Id>& vertices, MeshSink& sink,
                  Context& context) {
  Stage stage(context, "points");
  const Array<std::uint64_t>& begin = vertices.numbers().begin;
  Array<Vec3> points;
  Array<Index> tets;
  Array<CornerSet> corners;
  for (std::size_t t = 0; t < map.topology.tetCount();) {
    const Batch batch = nextBatch(begin, t);
    t = batch.endTet;
    const std::uint64_t first = begin[batch.firstTet];
    const auto count = static_cast<std::size_t>(begin[batch.endTet] - first);
    if (count == 0) continue;
    points.resize(count);
    tets.resize(count);
    corners.resize(count);
    const VertexArrays arrays{first, points.data(), tets.data(), corners.data()};
    parallelFor(stage, batch.endTet - batch.firstTet, kBatchGrain, [&](std::size_t i) {
      vertices.describe(static_cast<Index>(batch.firstTet + i), arrays);
    });
    sink.points({first, points, tets, corners});
  }
}

template <class Id>
void streamCells(const PreparedMap& map, const Atlas<Id>& atlas, MeshSink& sink, Context& context,
                 ExtractStatistics& statistics) {
  Stage stage(context, "cells");
  using Cell = typename CellEmitter<Id>::Cell;
  const Array<std::uint64_t>& begin = atlas.cells().begin;
  CellEmitters<Id> emitters(map, atlas);
  Array<Cell> cells;
  for (std::size_t t = 0; t < map.topology.tetCount();) {
    const Batch batch = nextBatch(begin, t);
    t = batch.endTet;
    const std::uint64_t first = begin[batch.firstTet];
    const auto count = static_cast<std::size_t>(begin[batch.endTet] - first);
    if (count == 0) continue;
    cells.resize(count);
    parallelBlocks(stage, batch.endTet - batch.firstTet, kBatchGrain,
                   [&](std::size_t from, std::size_t to, std::size_t) {
                     emitters.emit(batch.firstTet + from, batch.firstTet + to, first,
                                   std::span(cells));
                   });
    sink.cells(first, std::span<const Cell>(cells));
  }
  statistics.tracedCells = emitters.traced();
}

template <class Id>
void streamFrom(Atlas<Id>& atlas, const PreparedMap& map, MeshSink& sink, Context& context,
                ExtractStatistics& statistics) {
  atlas.fill({}, false, statistics);
  sink.begin(atlas.vertices().numbers().count(), atlas.cells().count());
  streamPoints(map, atlas.vertices(), sink, context);
  streamCells(map, atlas, sink, context, statistics);
  sink.end();
}

}  // namespace

HexMesh runAtlas(const PreparedMap& map, std::uint64_t expectedCells, Context& context,
                 ExtractStatistics& statistics, const EngineSwitches& switches,
                 SweepObserver* observer) {
  Atlas<Index> atlas(map, true, context, switches);
  const std::uint64_t count = atlas.sweep(expectedCells, observer);
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
             observer != nullptr, statistics);
  mesh.cells = emitAllCells(map, atlas, context, statistics);
  if (observer != nullptr) observer->take(atlas.takeVertices());
  return mesh;
}

void streamAtlas(const PreparedMap& map, std::uint64_t expectedCells, MeshSink& sink,
                 Context& context, ExtractStatistics& statistics, const EngineSwitches& switches) {
  if (!switches.wideIds) {
    Atlas<std::uint32_t> atlas(map, false, context, switches);
    if (atlas.sweep(expectedCells) <= kMaxNarrowVertices) {
      streamFrom(atlas, map, sink, context, statistics);
      return;
    }
  }
  Atlas<std::uint64_t> atlas(map, false, context, switches);
  static_cast<void>(atlas.sweep(expectedCells));
  streamFrom(atlas, map, sink, context, statistics);
}

}  // namespace hexhex
