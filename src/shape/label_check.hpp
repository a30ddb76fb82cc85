// Whether labels may be those of a polycube, and where not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <shape/label_costs.hpp>

#include <hexhex/shape.hpp>

namespace hexhex::shape {

/// What there is to be said of labels.
struct Verdict {
  LabelReport report;
  double energy = 0;          ///< the less, the better
  std::vector<Index> places;  ///< triangles at what is wrong
};

/// Each face of a polycube is bounded by loops of at least four edges, which turn by four right
/// angles; three faces meet in a corner, never opposite ones at an edge; edges run along an axis
/// without turning back, and two that connect the same planes in the same order; and no faces
/// overlap around a corner. A face is a disk with holes, of some width everywhere. (Sufficient
/// conditions are not known: Sokolov, Ray 2015.)
class LabelCheck {
 public:
  LabelCheck(const Surface& surface, const LabelCosts& costs);

  [[nodiscard]] Verdict operator()(const Labels& labels);

 private:
  /// Of a loop around a chart, from one corner to the next.
  struct Piece {
    std::size_t begin;  ///< in the loop
    std::size_t end;    ///< behind the last side; the loop goes round
    Side first = kNone;
    std::array<Index, 2> planes{};  ///< the charts at its ends, in one of which each lies
    double rise = 0;                ///< along its axis, in space
    lattice::Direction direction = 0;
    bool hasDirection = false;  ///< not between opposite labels
  };
  struct Loop {
    Index chart;
    std::size_t begin;  ///< of its pieces
    std::size_t end;
  };

  void reset();
  void visitTriangles(const Labels& labels, Verdict& verdict);
  void findCharts(const Labels& labels);
  void visitCorners(Verdict& verdict);
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

  struct Chart {
    Index first = 0;  ///< triangle
    int loops = 0;
    int turns = 0;  ///< right angles to the left, of all loops
    bool isBad = false;
    std::int64_t twiceCharacteristic = 0;
    std::vector<Index> above = {};  ///< charts that edges lead up to
  };
  std::vector<Chart> charts_;
  std::vector<Index> chartOf_;      ///< per triangle
  std::vector<Side> sideAt_;        ///< one per vertex of the surface
  std::vector<Side> borders_;       ///< sides between labels
  std::vector<Index> borderCount_;  ///< per vertex
  std::vector<bool> isDone_;        ///< per side
  std::vector<Side> loop_;
  std::vector<Loop> loops_;  ///< with corners
  std::vector<Piece> pieces_;
  std::vector<Index> stack_;
};

}  // namespace hexhex::shape
