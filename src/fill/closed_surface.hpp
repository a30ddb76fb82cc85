// Checks whether a surface bounds bodies, and finds them.
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/fill.hpp>

#include <base/stage.hpp>

namespace hexhex::fill {

/// A body without cavities, or together with the closed surfaces around its cavities.
struct Body {
  TriangleMesh surface;  ///< counter-clockwise as seen from outside the body
  TriangleMesh voids;    ///< the part of it that bounds cavities
  std::uint64_t voidCount = 0;
  double volume = 0;
};

struct Bodies {
  std::vector<Body> bodies;
  std::uint64_t flatTriangles = 0;  ///< removed, as they have no area
};

/// The bodies bounded by a surface, whatever the orientation of its triangles. A closed surface
/// inside another bounds a cavity, and one inside that bounds another body.
/// @throws Error  as fillSurface(), if it bounds no bodies
[[nodiscard]] Bodies bodiesOf(TriangleMesh surface, Stage& stage);

/// Winding number of a closed surface around a point: 0 outside. The point must not be on the
/// surface.
[[nodiscard]] int windings(const TriangleMesh& surface, const Vec3& point);

}  // namespace hexhex::fill
