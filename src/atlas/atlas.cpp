// The stages of the atlas engine, for whole meshes and for pieces (docs/developer/atlas.md).
#include <array>
#include <atomic>
#include <cassert>
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

namespace hexhex::atlas {

namespace {

/// More vertices than this need wide ids: two narrow ones are reserved.
constexpr std::uint64_t kMaxNarrowVertices = std::numeric_limits<std::uint32_t>::max() - 1;

void requireExpected(std::uint64_t cells, std::uint64_t expected) {
  if (cells == expected) return;
  throw Error(ErrorCode::Internal,
              "The map's parametric volume is " + std::to_string(expected) + ", but " +
                  std::to_string(cells) +
                  " cell centres were found. This is a bug; please report it with the map.");
}

constexpr std::array<WorkStep, 6> kEngineSteps = {{{"charts", 0.01},
                                                   {"sweep", 0.8},
                                                   {"grid", 1.5},
                                                   {"overlaps", 0.15},
                                                   {"cuts", 0.05},
                                                   {"cells", 1.3}}};
/// ... where writing a piece is part of making it.
constexpr std::array<WorkStep, 7> kStreamSteps = {{{"charts", 0.01},
                                                   {"sweep", 0.3},
                                                   {"grid", 0.4},
                                                   {"overlaps", 0.3},
                                                   {"cuts", 0.05},
                                                   {"points", 0.6},
                                                   {"cells", 1.2}}};

/// The stages up to a complete grid of vertices.
template <class Id>
class Atlas {
 public:
  Atlas(const igm::PreparedMap& map, bool keepLines, Context& context,
        const EngineSwitches& switches)
      : map_(map),
        vertices_(map, charts_, numbers_, keepLines),
        cells_(map.topology.tetCount(), keepLines),
        context_(context),
        switches_(switches) {
    Stage stage(context, "charts");
    charts_ = buildCharts(map, stage);
  }

  /// @param observer  sees every tet, if not null
  /// @return the number of vertices
  std::uint64_t sweep(std::uint64_t expectedCells, sweep::SweepObserver* observer = nullptr) {
    Stage stage(context_, "sweep");
    vertices_.sweep(cells_, stage, observer, switches_.fewPoints);
    requireExpected(cells_.count(), expectedCells);
    return vertices_.numbers().count();
  }

  /// @param keepLines  for takeVertices()
  void fill(const VertexArrays& arrays, bool keepLines, ExtractStatistics& statistics) {
    {
      Stage stage(context_, "grid");
      vertices_.fill(arrays, stage);
    }
    std::uint64_t overlappingTets = 0;
    {
      Stage stage(context_, "overlaps");
      if (switches_.resolveOverlaps) overlappingTets = vertices_.resolveOverlaps(stage);
    }
    statistics.overlappingTets = overlappingTets;
    Stage stage(context_, "cuts");
    if (switches_.markCuts) {
      Cuts cuts = markCutCells(map_, charts_, overlappingTets == 0, vertices_.grid(), stage);
      statistics.cutFaces = cuts.faces;
      transitions_ = std::move(cuts.transitions);
    }
    if (!keepLines) vertices_.dropLines();
    statistics.charts = charts_.count;
    statistics.generators = vertices_.numbers().generatorCounts;
    statistics.vertices = vertices_.numbers().vertexCounts;
  }

  [[nodiscard]] const VertexGrid<Id>& vertices() const noexcept { return vertices_; }
  [[nodiscard]] sweep::SweptVertices takeVertices() noexcept { return vertices_.takeVertices(); }
  [[nodiscard]] const sweep::CellCenters& cells() const noexcept { return cells_; }
  [[nodiscard]] CellEmitter<Id> makeEmitter() const {
    return {map_, vertices_, transitions_, switches_.lookAcrossCuts};
  }

 private:
  const igm::PreparedMap& map_;
  Charts charts_;
  sweep::VertexNumbers numbers_;
  VertexGrid<Id> vertices_;
  sweep::CellCenters cells_;
  CutTransitions transitions_;
  Context& context_;
  EngineSwitches switches_;
};

/// Tets per block where each has many elements.
constexpr std::size_t kFewTets = 64;

/// Consecutive tets, and the vertices or cells that they own.
struct Piece {
  std::size_t firstTet;
  std::size_t endTet;
  std::uint64_t first;
  std::size_t count;

  [[nodiscard]] std::size_t tetCount() const noexcept { return endTet - firstTet; }
};

/// Calls visit(Piece) for pieces of about a million elements.
/// @param begin  per tet (+1): the first element that it owns
template <class Visit>
void forEachPiece(const Array<std::uint64_t>& begin, const Visit& visit) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  const std::size_t tets = begin.size() - 1;
  for (std::size_t first = 0, end = 0; first < tets; first = end) {
    end = first + 1;
    while (end < tets && begin[end + 1] - begin[first] <= kPiece) ++end;
    assert(begin[first] <= begin[end]);
    const auto count = static_cast<std::size_t>(begin[end] - begin[first]);
    if (count > 0) visit(Piece{first, end, begin[first], count});
  }
}

/// Emits the cells of a piece.
/// @return how many have a corner that their chart does not show
template <class Id>
std::uint64_t emitCells(const igm::PreparedMap& map, const Atlas<Id>& atlas, const Piece& piece,
                        std::span<typename CellEmitter<Id>::Cell> cells, Stage& stage) {
  struct Workspace {
    CellEmitter<Id> emitter;
    std::vector<lattice::SweptLine> lines;  ///< of a tet, if they are not kept
  };
  const Array<std::uint64_t>& begin = atlas.cells().begin;
  std::atomic<std::uint64_t> resolved{0};
  parallelBlocksWith(
      stage, piece.tetCount(), kFewTets,
      [&] {
        return Workspace{atlas.makeEmitter(), {}};
      },
      [&](std::size_t from, std::size_t to, std::size_t /*block*/, Workspace& workspace) {
        for (std::size_t t = piece.firstTet + from; t < piece.firstTet + to; ++t) {
          if (begin[t] == begin[t + 1]) continue;
          const auto tet = static_cast<Index>(t);
          resolved += workspace.emitter.emit(
              tet, atlas.cells().linesOf(map.exact, tet, workspace.lines),
              cells.subspan(begin[t] - piece.first, begin[t + 1] - begin[t]));
        }
      });
  return resolved;
}

template <class Id>
void streamPoints(const VertexGrid<Id>& vertices, MeshSink& sink, Context& context) {
  Stage stage(context, "points");
  stage.setTotal(vertices.numbers().begin.size() - 1);
  Array<Vec3> points;
  Array<Index> tets;
  Array<CornerSet> corners;
  forEachPiece(vertices.numbers().begin, [&](const Piece& piece) {
    points.resize(piece.count);
    tets.resize(piece.count);
    corners.resize(piece.count);
    const VertexArrays arrays{piece.first, points.data(), tets.data(), corners.data()};
    parallelFor(stage, piece.tetCount(), kFewTets, [&](std::size_t i) {
      vertices.describe(static_cast<Index>(piece.firstTet + i), arrays);
    });
    sink.points({piece.first, points, tets, corners});
  });
}

template <class Id>
void streamCells(const igm::PreparedMap& map, const Atlas<Id>& atlas, MeshSink& sink,
                 Context& context, ExtractStatistics& statistics) {
  Stage stage(context, "cells");
  stage.setTotal(map.topology.tetCount());
  using Cell = typename CellEmitter<Id>::Cell;
  Array<Cell> cells;
  forEachPiece(atlas.cells().begin, [&](const Piece& piece) {
    cells.resize(piece.count);
    statistics.tracedCells += emitCells(map, atlas, piece, std::span<Cell>(cells), stage);
    sink.cells(piece.first, std::span<const Cell>(cells));
  });
}

template <class Id>
void streamFrom(Atlas<Id>& atlas, const igm::PreparedMap& map, MeshSink& sink, Context& context,
                ExtractStatistics& statistics) {
  atlas.fill({}, false, statistics);
  sink.begin(atlas.vertices().numbers().count(), atlas.cells().count());
  streamPoints(atlas.vertices(), sink, context);
  streamCells(map, atlas, sink, context, statistics);
  sink.end();
}

}  // namespace

HexMesh runAtlas(const igm::PreparedMap& map, std::uint64_t expectedCells, Context& context,
                 ExtractStatistics& statistics, const EngineSwitches& switches,
                 sweep::SweepObserver* observer) {
  const WorkSteps steps(context, "engine", kEngineSteps);
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
  {
    Stage stage(context, "cells");
    mesh.cells.resize(atlas.cells().count());
    const Piece all{0, map.topology.tetCount(), 0, mesh.cells.size()};
    statistics.tracedCells = emitCells(map, atlas, all, std::span<Hex>(mesh.cells), stage);
  }
  if (observer != nullptr) observer->take(atlas.takeVertices());
  return mesh;
}

void streamAtlas(const igm::PreparedMap& map, std::uint64_t expectedCells, MeshSink& sink,
                 Context& context, ExtractStatistics& statistics, const EngineSwitches& switches) {
  const WorkSteps steps(context, "engine", kStreamSteps);
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

}  // namespace hexhex::atlas
