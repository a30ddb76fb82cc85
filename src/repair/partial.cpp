// Extracts single cells, wherever valid tets fill a cube.
#include <algorithm>
#include <array>
#include <map>
#include <string>

#include <adjacency/hex_topology.hpp>

#include <hexhex/partial.hpp>

#include <igm/measures.hpp>
#include <lattice/tet_rasterizer.hpp>
#include <repair/cell_flood.hpp>
#include <repair/valid_tets.hpp>

namespace hexhex::repairs {

namespace {

constexpr std::size_t kTetGrain = 64;

struct FoundCell {
  std::array<CellFlood::Corner, 8> corners;
  std::uint8_t boundaryWalls = 0;  ///< bit per face
};

struct Found {
  std::vector<FoundCell> cells;
  std::vector<std::pair<Index, double>> covered;  ///< tets, and their volumes that a cell covers
};

/// Finds the cells whose centres a tet owns.
class CellFinder {
 public:
  CellFinder(const igm::PreparedMap& map, std::span<const std::uint8_t> valid)
      : map_(map), valid_(valid), flood_(map, valid) {}

  void run(Index tet, Found& found) {
    centres_.clear();
    lattice::TetRasterizer(map_.exact.corners[tet], map_.exact.unit)
        .sweep(lattice::kCenterGrid, [&](const lattice::SweptLine& line) {
          for (std::uint32_t i = 0; i < line.count; ++i) centres_.push_back(line.point(i));
        });
    // The sweep's axes depend on the tet; sorting makes the order of cells the same for all tets.
    std::sort(centres_.begin(), centres_.end());
    for (const lattice::GridPoint& z : centres_) tryCell(tet, z, found);
  }

 private:
  void tryCell(Index tet, const lattice::GridPoint& z, Found& found) {
    if (!flood_.run(tet, z)) return;
    lattice::LatticePoint centre{};
    for (std::size_t k = 0; k < 3; ++k) {
      centre[k] = std::int64_t{z[k]} * map_.exact.unit + map_.exact.unit / 2;
    }
    // A centre between tets belongs to the smallest of them.
    for (const CellFlood::Piece& piece : flood_.pieces()) {
      if (piece.tet < tet && lattice::simplexOf(piece.corners, centre) != lattice::kNoSimplex)
        return;
    }
    FoundCell cell;
    for (std::size_t i = 0; i < 8; ++i) {
      const std::optional<CellFlood::Corner> corner = flood_.corner(i);
      if (!corner) return;
      cell.corners[i] = *corner;
    }
    for (std::size_t wall = 0; wall < 6; ++wall) {
      if (flood_.isOnBoundary(wall)) {
        cell.boundaryWalls = static_cast<std::uint8_t>(cell.boundaryWalls | (1U << wall));
      }
    }
    found.cells.push_back(cell);
    for (const CellFlood::Piece& piece : flood_.pieces()) {
      found.covered.emplace_back(piece.tet, piece.volume);
    }
  }

  const igm::PreparedMap& map_;
  std::span<const std::uint8_t> valid_;
  CellFlood flood_;
  std::vector<lattice::GridPoint> centres_;  ///< by smallest corner of the cell; reused
};

/// Numbers the vertices of all cells by their names.
void assemble(const std::vector<Found>& blocks, PartialMesh& result,
              std::vector<std::uint8_t>& boundaryWalls) {
  std::vector<std::pair<VertexName, std::size_t>> names;  // and their places in the mesh
  std::vector<Vec3> positions;
  for (const Found& block : blocks) {
    for (const FoundCell& cell : block.cells) {
      for (const CellFlood::Corner& corner : cell.corners) {
        names.emplace_back(corner.name, names.size());
        positions.push_back(corner.position);
      }
      boundaryWalls.push_back(cell.boundaryWalls);
    }
  }
  std::sort(names.begin(), names.end());
  result.mesh.cells.resize(boundaryWalls.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == 0 || !(names[i].first == names[i - 1].first)) {
      result.mesh.points.push_back(positions[names[i].second]);
    }
    result.mesh.cells[names[i].second / 8][names[i].second % 8] =
        static_cast<Index>(result.mesh.points.size() - 1);
  }
}

/// Marks cells at holes: those with a face that has no other cell behind it although the tets
/// continue.
void matchFaces(const std::vector<std::uint8_t>& boundaryWalls, Stage& stage, PartialMesh& result) {
  const adjacency::HexFaces faces =
      adjacency::findFaces(result.mesh, adjacency::cellsAroundVertices(result.mesh, stage), stage);
  result.mesh.regions.assign(result.mesh.cells.size(), 0);
  for (std::size_t c = 0; c < boundaryWalls.size(); ++c) {
    if ((faces.boundary[c] & ~boundaryWalls[c]) != 0) result.mesh.regions[c] = 1;
  }
  result.faceConflicts = faces.overfull.count + faces.sameDirection.count;
}

double volumeOf(const igm::ExactMap& map, std::size_t t) {
  const lattice::LatticeTet& c = map.corners[t];
  const auto unit = static_cast<double>(map.unit);
  return lattice::orientationDeterminant(c[0], c[1], c[2], c[3]).toDouble() /
         (6 * unit * unit * unit);
}

/// Cells are collected, each with names for its corners, before they are numbered.
void requireNumbers(const igm::PreparedMap& map, std::span<const std::uint8_t> valid) {
  double cells = 0;
  for (std::size_t t = 0; t < valid.size(); ++t) cells += valid[t] * volumeOf(map.exact, t);
  static_cast<void>(igm::scaledCells(
      static_cast<std::uint64_t>(std::min(cells, igm::kMaxCountedCells)), 1, kNone));
}

/// Connected tets that are not covered.
void collectHoles(const igm::PreparedMap& map, std::span<const std::uint8_t> valid,
                  const std::vector<Found>& blocks, PartialMesh& result) {
  const adjacency::TetTopology& topology = map.topology;
  std::vector<double> missing(topology.tetCount());
  for (std::size_t t = 0; t < missing.size(); ++t) missing[t] = volumeOf(map.exact, t);
  for (const Found& block : blocks) {
    for (const auto& [tet, volume] : block.covered) missing[tet] -= volume;
  }
  const auto isOpen = [&](Index t) { return valid[t] == 0 || missing[t] > CellFlood::kSlack; };
  DisjointSets sets = componentsOf(topology, isOpen);
  std::map<Index, Hole> holes;
  for (Index t = 0; t < topology.tetCount(); ++t) {
    if (!isOpen(t)) continue;
    Hole& hole = holes[sets.find(t)];
    hole.tet = std::min(hole.tet, t);
    ++hole.tets;
    hole.invalidTets += valid[t] == 0 ? 1 : 0;
    hole.missingCells += missing[t];
    for (const Index v : topology.tets[t]) {
      for (std::size_t k = 0; k < 3; ++k) hole.position[k] += map.input.view.points[v][k] / 4;
    }
  }
  for (auto& [root, hole] : holes) {
    for (double& x : hole.position) x /= static_cast<double>(hole.tets);
    result.invalidTets += hole.invalidTets;
    result.missingCells += hole.missingCells;
    result.holes.push_back(hole);
  }
  std::sort(result.holes.begin(), result.holes.end(), [](const Hole& a, const Hole& b) {
    return a.missingCells != b.missingCells ? a.missingCells > b.missingCells : a.tet < b.tet;
  });
}

}  // namespace

}  // namespace hexhex::repairs

namespace hexhex {

PartialMesh extractPartial(const TetMapView& map, const PartialOptions& options, Context& context) {
  constexpr std::array<WorkStep, 3> kSteps = {
      {{"prepare", 0.1}, {"valid tets", 0.1}, {"cells", 1}}};
  WorkSteps steps(context, "extractPartial", kSteps);
  PartialMesh result;
  withThreads(context.threads(), [&] {
    igm::DefectCollector defects;
    igm::PreparedMap prepared =
        igm::prepareMap(map, options.tolerance, options.scale, context, defects);
    if (prepared.exact.corners.empty()) defects.throwIfAny();
    std::vector<std::uint8_t> valid;
    {
      Stage stage(context, "valid tets");
      valid = repairs::findValidTets(prepared, igm::LocalParameters(prepared.input),
                                     options.tolerance, stage);
      igm::scaleMap(prepared.exact, options.scale, stage);
    }
    repairs::requireNumbers(prepared, valid);
    std::vector<repairs::Found> blocks(blockCount(valid.size(), repairs::kTetGrain));
    Stage stage(context, "cells");
    parallelBlocks(stage, valid.size(), repairs::kTetGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     repairs::CellFinder finder(prepared, valid);
                     for (std::size_t t = begin; t < end; ++t) {
                       if (valid[t] != 0) finder.run(static_cast<Index>(t), blocks[block]);
                     }
                   });
    std::vector<std::uint8_t> boundaryWalls;
    repairs::assemble(blocks, result, boundaryWalls);
    repairs::matchFaces(boundaryWalls, stage, result);
    repairs::collectHoles(prepared, valid, blocks, result);
  });
  steps.finish();
  return result;
}

}  // namespace hexhex
