// Carries tags of a tet mesh over to a mesh made from it by splitting edges and tets.
#pragma once

#include <span>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::tetmap {

/// Where the vertices added by splits lie in the mesh that was split first.
class AddedVertices {
 public:
  explicit AddedVertices(std::size_t given) : given_(given) {}

  /// The next vertex lies between these.
  void add(std::span<const Index> vertices) { simplices_.push_back(simplexOf(vertices)); }
  [[nodiscard]] bool empty() const noexcept { return simplices_.empty(); }

  /// The corners of the smallest simplex of the given mesh that contains all these vertices of one
  /// of its tets: ascending, followed by kNone.
  [[nodiscard]] Tet simplexOf(std::span<const Index> vertices) const;

 private:
  std::size_t given_;
  std::vector<Tet> simplices_;
};

/// Gives the simplices of a map the tags of the simplices that they are parts of.
/// @param features, regions  of the mesh that was split
/// @param parents  per tet of the map: the tet of that mesh of which it is a part
void carryTags(FeaturesView features, std::span<const std::int32_t> regions,
               const AddedVertices& added, std::span<const Index> parents, TetMap& map);

}  // namespace hexhex::tetmap
