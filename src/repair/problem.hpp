// From a patch to an optimization problem and back.
#pragma once

#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <repair/freedom.hpp>
#include <repair/untangle.hpp>

namespace hexhex {

/// A tet that no parameters make positive, whatever its vertices do: all four corners in one
/// integer plane to which they are bound, or three of them on one line.
struct LockedTet {
  Index tet;
  CornerMask corners;  ///< the ones in question
};

class PatchProblem {
 public:
  /// @param vertices  by findFreedom()
  PatchProblem(const TetMapView& map, const TetTopology& topology,
               const LocalParameters& parameters, const Patch& patch,
               std::span<const PatchVertex> vertices);

  /// Locked tets among the seeds.
  [[nodiscard]] std::vector<LockedTet> lockedTets(const Patch& patch) const;

  [[nodiscard]] UntangleProblem& problem() { return problem_; }

  /// The parameter of a vertex of the patch in the chart of its first corner, by the unknowns,
  /// rounded to multiples of a quantum.
  [[nodiscard]] Vec3 parameterOf(std::size_t vertex, double quantum) const;
  /// Whether any coordinate of a vertex of the patch is unknown.
  [[nodiscard]] bool mayMove(std::size_t vertex) const;

 private:
  void addTet(Index tet, double scale);
  [[nodiscard]] UntangleCorner cornerOf(Index tet, int corner) const;
  [[nodiscard]] std::size_t patchVertexOf(Index vertex) const;
  [[nodiscard]] double parametricScale(const Patch& patch) const;

  const TetMapView& map_;
  const TetTopology& topology_;
  const LocalParameters& parameters_;
  std::span<const PatchVertex> vertices_;
  std::vector<std::array<int, 3>> unknowns_;  ///< per vertex and axis of its first chart, or -1
  UntangleProblem problem_;
};

}  // namespace hexhex
