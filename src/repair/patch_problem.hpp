// From a patch to an optimization problem and back: the coordinates along which its vertices may
// move, given by the constraints of Section 5.1.3 in the patch's own charts, and the tets to
// untangle.
#pragma once

#include <span>
#include <vector>

#include <untangle/problem.hpp>

#include <hexhex/types.hpp>

#include <repair/patch_charts.hpp>

namespace hexhex::repairs {

/// A vertex of a patch. Its parameter in the chart of its first corner determines all others.
struct PatchVertex {
  Index vertex = 0;
  Vec3 parameter{};            ///< in the chart of corners.front(); integers where fixed
  lattice::AxisSet fixed = 0;  ///< axes of that chart along which it must stay
  bool singular = false;
  bool boundary = false;
  double off = 0;  ///< distance of the fixed coordinates from integers
  struct Copy {
    adjacency::CornerIndex corner;
    lattice::Transition fromFirst;
  };
  std::vector<Copy> corners;  ///< all corners at the vertex
};

/// One entry per vertex of the patch.
[[nodiscard]] std::vector<PatchVertex> findFreedom(const igm::LocalParameters& parameters,
                                                   const Patch& patch, const PatchCharts& charts);

/// A tet that no parameters make positive: all four corners are bound to one integer plane, or
/// three of them to one line.
struct LockedTet {
  Index tet;
  lattice::CornerMask corners;  ///< the corners in question
};

class PatchProblem {
 public:
  /// @param vertices  from findFreedom()
  PatchProblem(const TetMapView& map, const adjacency::TetTopology& topology,
               const igm::LocalParameters& parameters, const Patch& patch,
               std::span<const PatchVertex> vertices);

  /// Locked tets among the start tets.
  [[nodiscard]] std::vector<LockedTet> lockedTets(const Patch& patch) const;

  [[nodiscard]] untangle::Problem& problem() { return problem_; }

  /// The parameter of a vertex of the patch in the chart of its first corner, given by the
  /// unknowns, rounded to multiples of a quantum.
  [[nodiscard]] Vec3 parameterOf(std::size_t vertex, double quantum) const;
  /// Whether any coordinate of a vertex of the patch is unknown.
  [[nodiscard]] bool mayMove(std::size_t vertex) const;

 private:
  void addTet(Index tet, double scale);
  [[nodiscard]] untangle::Corner cornerOf(Index tet, int corner) const;
  [[nodiscard]] std::size_t patchVertexOf(Index vertex) const;
  [[nodiscard]] double parametricScale(const Patch& patch) const;

  const TetMapView& map_;
  const adjacency::TetTopology& topology_;
  const igm::LocalParameters& parameters_;
  std::span<const PatchVertex> vertices_;
  double magnification_;                      ///< factor on edges in space
  std::vector<std::array<int, 3>> unknowns_;  ///< per vertex and axis of its first chart, or -1
  untangle::Problem problem_;
};

}  // namespace hexhex::repairs
