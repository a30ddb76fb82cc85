// Loops along the handles of a solid, found on its surface.
#pragma once

#include <optional>
#include <vector>

#include <shape/edge_classes.hpp>
#include <shape/surface.hpp>

#include <base/stage.hpp>
#include <lattice/direction.hpp>

namespace hexhex::shape {

/// The columns that a wall around a graph must have: one per direction.
inline constexpr int kLeastColumns = 4;

/// A connected graph on each component of a surface: loops and paths between them, or a vertex of a
/// component without handles. Its neighbourhood is a disk with as many holes as the component has
/// handles, and so is the rest of the component.
struct LoopGraph {
  std::vector<bool> has;                  ///< per vertex
  std::vector<tetmap::VertexPair> edges;  ///< ascending
};

/// Finds disjoint short loops, as many as there are handles, that are independent in the solid:
/// none, and no sum of them, bounds a surface inside, so each runs along a handle, not around it,
/// and together they do not separate the surface.
///
/// There always are such loops, as half of the homology of the surface lives in the solid: what
/// bounds inside, and is crossed by none of the loops found so far, has one dimension per loop that
/// is missing, and what crosses it does not bound.
class HandleLoops {
 public:
  /// @param surface, points  must outlive this
  HandleLoops(const std::vector<Tet>& tets, const Surface& surface, const std::vector<Vec3>& points,
              Stage& stage);

  /// Prefers what faces one way.
  /// @return nothing if there are too few vertices for loops and paths
  [[nodiscard]] std::optional<LoopGraph> graph(lattice::Direction up, Stage& stage) const;

 private:
  struct Component {
    std::vector<Index> vertices;  ///< ascending
    std::size_t handles = 0;
  };
  /// The highest vertex that faces up, where walls have room for all columns, or kNone.
  [[nodiscard]] Index tip(const Component& component, lattice::Direction up) const;

  const Surface& surface_;
  const std::vector<Vec3>& points_;
  std::vector<Side> sideAt_;            ///< per vertex
  std::vector<HomologyClass> classes_;  ///< per side
  std::vector<Component> components_;
};

}  // namespace hexhex::shape
