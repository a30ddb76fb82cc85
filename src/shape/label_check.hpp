// Checks whether labels may be those of a polycube, and finds faults.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <shape/label_costs.hpp>
#include <shape/label_winding.hpp>

#include <hexhex/shape.hpp>

namespace hexhex::shape {

/// The outcome of a check.
struct Verdict {
  LabelReport report;
  double energy = 0;          ///< lower is better
  std::vector<Index> places;  ///< triangles at faults
};

/// Necessary conditions for labels of a polycube; sufficient ones are not known (Sokolov, Ray
/// 2015).
///
/// Each chart is a disk with holes and a positive width everywhere, bounded by loops of at least
/// four edges that turn by four right angles. Three charts meet at a corner, and opposite labels
/// never at an edge. Edges run along an axis without turning back, and all edges between two planes
/// run in the same direction. No faces overlap around a corner. Labels wind around each vertex as
/// normals do; in pairs that cancel each other, exceptions may be possible, but had no map.
class LabelCheck {
 public:
  LabelCheck(const Surface& surface, const LabelCosts& costs);

  [[nodiscard]] Verdict operator()(const Labels& labels);

 private:
  /// The part of a loop around a chart between two corners.
  struct Piece {
    std::size_t begin;  ///< first side, in the loop
    std::size_t end;    ///< after the last side, modulo the loop's size
    Side first = kNone;
    std::array<Index, 2> planes{};  ///< the charts across its two ends, in whose planes these lie
    double rise = 0;                ///< extent along its axis, in space
    lattice::Direction direction = 0;
    bool hasDirection = false;  ///< false between opposite labels
  };
  struct Loop {
    Index chart;
    std::size_t begin;  ///< first piece
    std::size_t end;
  };

  void reset();
  void visitTriangles(const Labels& labels, Verdict& verdict);
  void findCharts(const Labels& labels);
  void visitCorners(Verdict& verdict);
  void visitWindings(const Labels& labels, Verdict& verdict);
  void walkLoop(const Labels& labels, Side first);
  void visitLoop(const Labels& labels, Verdict& verdict);
  void addPieces();
  void visitPiece(const Labels& labels, Piece& piece, Verdict& verdict);
  void setDirections(const Labels& labels);
  void addPlaces(const Loop& loop, Verdict& verdict) const;
  void visitTurns(const Labels& labels, const Loop& loop, Verdict& verdict);
  void visitRoom(const Labels& labels, Verdict& verdict);
  void setCharacteristics();
  void visitCharts(Verdict& verdict) const;
  [[nodiscard]] bool isBelow(Index low, Index high);
  void visitWidths(const Labels& labels, Verdict& verdict);

  const Surface& surface_;
  const LabelCosts& costs_;
  LabelWinding windingOf_;

  struct Chart {
    Index first = 0;  ///< triangle
    int loops = 0;
    int turns = 0;  ///< number of right angles to the left, over all loops
    bool isBad = false;
    std::int64_t twiceCharacteristic = 0;
    std::vector<Index> above = {};  ///< charts that edges lead up to
  };
  std::vector<Chart> charts_;
  std::vector<Index> chartOf_;      ///< per triangle
  std::vector<Side> sideAt_;        ///< one per vertex, with that tail
  std::vector<Side> borders_;       ///< sides between labels
  std::vector<Index> borderCount_;  ///< per vertex
  std::vector<bool> isDone_;        ///< per side
  std::vector<Side> loop_;
  std::vector<Loop> loops_;  ///< those with corners
  std::vector<Piece> pieces_;
  std::vector<Index> stack_;
};

}  // namespace hexhex::shape
