// Is a surface the boundary of bodies, and of which?
#pragma once

#include <cstdint>
#include <vector>

#include <hexhex/fill.hpp>

#include <base/stage.hpp>

namespace hexhex::fill {

/// A body without cavities, or with the closed surfaces around these.
struct Body {
  TriangleMesh surface;  ///< counterclockwise as seen from where there is no body
  TriangleMesh voids;    ///< the part of it that bounds cavities
  std::uint64_t voidCount = 0;
  double volume = 0;
};

/// The bodies that a surface bounds, whatever the orientation of its triangles. One closed surface
/// inside of another bounds a cavity, and one inside of that another body.
/// @throws Error  as fillSurface(), for what is no such surface
[[nodiscard]] std::vector<Body> bodiesOf(TriangleMesh surface, Stage& stage);

/// How often a closed surface goes around a point: 0 outside. Points must not be on it.
[[nodiscard]] int windings(const TriangleMesh& surface, const Vec3& point);

}  // namespace hexhex::fill
