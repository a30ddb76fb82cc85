// Exact orientation predicates: the side of a plane, or of a line in an axis-parallel plane.
#pragma once

#include <cstddef>

#include <hexhex/types.hpp>

namespace hexhex::fill {

/// The sign of the volume of a tet: of det(b - a, c - a, d - a).
[[nodiscard]] int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The sign of the area of a triangle seen along an axis: of component `axis` of the cross product
/// of b - a and c - a.
[[nodiscard]] int orientation(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t axis);

}  // namespace hexhex::fill
