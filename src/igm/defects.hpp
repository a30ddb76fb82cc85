// The defects of a map, and of its tet mesh if that is not a manifold. (Section 3.1 says what is
// right.)
#pragma once

#include <map>
#include <mutex>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/check.hpp>
#include <hexhex/error.hpp>

namespace hexhex::igm {

/// Collects violated conditions from parallel loops: counts all and keeps the ten worst of each
/// kind. The outcome does not depend on the order of arrival.
class DefectCollector {
 public:
  /// Thread-safe. `amount` in parameter units; larger is worse.
  void add(ErrorCode code, Place place, double amount);

  /// From now on, corners 2 and 3 of tets are swapped relative to the caller's tets, in whose terms
  /// faces are reported.
  void setCornersReversed(bool reversed) { cornersReversed_ = reversed; }

  /// Forgets everything added so far.
  void clear() { defects_.clear(); }

  [[nodiscard]] bool empty() const { return defects_.empty(); }
  [[nodiscard]] bool has(ErrorCode code) const { return defects_.contains(code); }

  /// If this defect occurs, others follow from it: it is reported first.
  void setRootCause(ErrorCode code) { rootCause_ = code; }

  /// All defects: the root cause, then the others in the order of the codes.
  [[nodiscard]] std::vector<Defect> defects() const;

  /// Throws the first of defects(), if any, as an Error whose message names its worst place.
  void throwIfAny() const;

 private:
  std::mutex mutex_;
  std::map<ErrorCode, Defect> defects_;
  bool cornersReversed_ = false;
  ErrorCode rootCause_ = ErrorCode::Internal;
};

/// Builds adjacency through faces and collects defects; after a defect the result must not be used.
/// Checks faces (non-manifold, inconsistent orientation); whether edges and vertices are manifold
/// is up to computeSingularities().
/// @param map  has passed readInput()
[[nodiscard]] adjacency::TetTopology buildTopology(const TetMapView& map, Stage& stage,
                                                   DefectCollector& defects);

/// Goes through all faces, edges and vertices and names those that keep the mesh from being an
/// oriented manifold with boundary. Slow and simple: for meshes in which faster checks have found
/// something wrong.
/// @param topology  needs `tets` and `pointCount`; receives `mate` and the stars
void collectTopologyDefects(adjacency::TetTopology& topology, Stage& stage,
                            DefectCollector& defects);

}  // namespace hexhex::igm
