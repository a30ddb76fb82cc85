// Whether labels may be those of a polycube, and where not.
#pragma once

#include <array>
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
/// angles; three faces meet in a corner, never opposite ones at an edge; and edges run along an
/// axis without turning back. (Sufficient conditions are not known: Sokolov, Ray 2015. A chart of a
/// higher genus than a disk with holes is none either.)
class LabelCheck {
 public:
  LabelCheck(const Surface& surface, const LabelCosts& costs);

  [[nodiscard]] Verdict operator()(const Labels& labels);

 private:
  /// Of a loop around a chart, from one corner to the next.
  struct Piece {
    std::size_t begin;
    std::size_t end;  ///< behind the last side; the loop goes round
  };

  void reset();
  void visitTriangles(const Labels& labels, Verdict& verdict);
  void findCharts(const Labels& labels);
  void visitCorners(Verdict& verdict);
  void walkLoop(const Labels& labels, Side first);
  void visitLoop(const Labels& labels, Verdict& verdict);
  [[nodiscard]] std::vector<Piece> pieces() const;
  [[nodiscard]] Vec3 visitPiece(const Labels& labels, const Piece& piece, Verdict& verdict);
  void visitCharts(Verdict& verdict) const;

  const Surface& surface_;
  const LabelCosts& costs_;

  struct Chart {
    Index first = 0;  ///< triangle
    int loops = 0;
    int turns = 0;  ///< right angles to the left, of all loops
    bool isBad = false;
  };
  std::vector<Chart> charts_;
  std::vector<Index> chartOf_;      ///< per triangle
  std::vector<Side> borders_;       ///< sides between labels
  std::vector<Index> borderCount_;  ///< per vertex
  std::vector<bool> isDone_;        ///< per side
  std::vector<Side> loop_;
  std::vector<Index> stack_;
};

}  // namespace hexhex::shape
