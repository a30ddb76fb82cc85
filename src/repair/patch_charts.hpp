// How the charts of a patch fit together, and what is singular in it: derived from what its
// triangles allow and what is plausible at its edges, since angles are meaningless where tets are
// flipped or flat.
//
// For example, a triangle that is flat in the map, on an axis-parallel line, fits four rotations
// equally well, and a flat boundary triangle lies in two integer planes. Changing a choice moves
// singular edges across that triangle, from one side to the other two. Of all choices that give
// every edge a sensible holonomy, the one with the fewest singular edges is taken: it leaves the
// most vertices free.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/input.hpp>
#include <igm/transition_fit.hpp>
#include <lattice/grid_motion.hpp>
#include <repair/patch.hpp>

namespace hexhex::repairs {

/// What a repair knows about one edge of a patch.
struct PatchEdge {
  Index vertex0 = 0;  ///< the smaller one
  Index vertex1 = 0;
  Index tet = 0;  ///< where its fan begins; on the boundary, one with a boundary face at the edge
  bool boundary = false;
  bool sound = false;  ///< no bad tet at it, so angles can be trusted
  bool singular = false;
  int axis = 0;     ///< of a singular edge: the axis along which it runs, in the chart of `tet`
  int valence = 0;  ///< number of hexahedra around it if known, else 0
};

class PatchCharts {
 public:
  /// @param map  the topology's view, for known rotations and valences
  /// @param tolerance  maximum distance of triangles from integer conditions
  PatchCharts(const TetMapView& map, const adjacency::TetTopology& topology,
              const igm::LocalParameters& parameters, const Patch& patch, double tolerance);

  /// For an inner half-face at a vertex of the patch: from its tet's chart to its mate's.
  [[nodiscard]] lattice::Transition across(adjacency::HalfFace halfFace) const;
  /// For a boundary half-face at a vertex of the patch: the axis across it.
  [[nodiscard]] int boundaryAxis(adjacency::HalfFace halfFace) const;
  /// All edges at vertices of the patch, sorted by vertices.
  [[nodiscard]] std::span<const PatchEdge> edges() const { return edges_; }
  /// The first edge with a holonomy that no integer-grid map has, or null.
  [[nodiscard]] const PatchEdge* impossibleEdge() const;

 private:
  struct Face {
    adjacency::HalfFace halfFace;  ///< inner: the smaller of the two
    bool boundary;
    std::vector<lattice::Transition> candidates;  ///< inner: best first
    std::vector<int> axes;                        ///< boundary: best first
    std::size_t chosen = 0;
    std::vector<std::uint32_t> edges;  ///< the edges of the face

    [[nodiscard]] std::size_t choices() const { return boundary ? axes.size() : candidates.size(); }
  };
  /// One step around an edge: through which face, and in which direction.
  struct FanStep {
    std::uint32_t face;
    bool forward;
  };
  struct Fan {
    std::vector<FanStep> steps;
    std::uint32_t firstBoundary = 0;  ///< faces where a fan on the boundary begins and ends
    std::uint32_t lastBoundary = 0;
    Vec3 vector{};  ///< the edge in the chart of its first tet
  };

  void collectFaces(const Patch& patch);
  void findCandidates();
  [[nodiscard]] std::vector<igm::FittedTransition> fitsOf(adjacency::HalfFace halfFace) const;
  [[nodiscard]] std::vector<int> planesOf(adjacency::HalfFace halfFace) const;
  void collectEdges(const Patch& patch);
  void walkFan(PatchEdge& edge, Fan& fan) const;
  void resolve();
  bool improve(std::span<const std::uint32_t> faces);
  bool improvePairs(std::uint32_t f);
  void classify();
  bool classifyByPlanes(std::size_t e);
  bool classifyByHolonomy(std::size_t e);
  void classifyByValence(std::size_t e);
  [[nodiscard]] std::pair<int, int> planesAt(const Fan& fan) const;
  void setValence(std::size_t e);
  [[nodiscard]] bool isOnGridLine(Index tet, const PatchEdge& edge) const;
  [[nodiscard]] double signedAngle(const PatchEdge& edge, const Fan& fan) const;
  [[nodiscard]] std::size_t faceIndex(adjacency::HalfFace halfFace) const;
  [[nodiscard]] lattice::Rotation holonomy(const Fan& fan) const;
  [[nodiscard]] double edgeCost(std::size_t e) const;

  const TetMapView& map_;
  const adjacency::TetTopology& topology_;
  const igm::LocalParameters& parameters_;
  double tolerance_;
  double fitLimit_ = 0;      ///< maximum residual of a rotation that fits a triangle
  std::vector<Face> faces_;  ///< by half-face
  std::vector<PatchEdge> edges_;
  std::vector<Fan> fans_;
  std::vector<std::uint32_t> ambiguous_;
};

}  // namespace hexhex::repairs
