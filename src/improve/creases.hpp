// Creases that keep cells from being positive: vertices may leave them as a last resort.
//
// The boundary of a mesh with bad cells is jagged where these are, and its sharp edges there are no
// features of the object.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

class LooseVertices {
 public:
  /// Lets go those of a list that lie on patches, on creases, or where these meet; from now on,
  /// they move on all patches that only creases divide.
  /// @param places  outlives this
  LooseVertices(VertexPlaces& places, std::span<const Index> vertices, const Array<Vec3>& points);

  [[nodiscard]] bool empty() const noexcept { return held_.empty(); }

  /// Holds those again that are where they were.
  /// @return the others
  std::vector<Index> holdUnmoved(const Array<Vec3>& points);

 private:
  struct Held {
    Index vertex;
    Freedom freedom;
    Index simplex;
    Vec3 point;
  };
  VertexPlaces& places_;
  std::vector<Held> held_;
};

}  // namespace hexhex::improvement
