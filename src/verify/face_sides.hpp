// On which sides of its faces do points of a tet lie? For many points: by planes in floating point
// with a proven bound, and by the exact predicate where that cannot tell.
#pragma once

#include <lattice/tet_geometry.hpp>

namespace hexhex {

class FaceSides {
 public:
  explicit FaceSides(const LatticeTet& tet) noexcept : tet_(tet) {
    for (std::size_t f = 0; f < 4; ++f) {
      const LatticePoint& p = corner(f, 0);
      const LatticePoint u = corner(f, 1) - p;
      const LatticePoint v = corner(f, 2) - p;
      for (std::size_t k = 0; k < 3; ++k) normals_[f][k] = signedToDouble(crossComponent(u, v, k));
    }
  }

  /// The simplex that has a point in its interior, or kNoSimplex outside of the tet.
  [[nodiscard]] CornerMask simplexOf(const LatticePoint& point) const noexcept {
    return simplexBySides([&](std::size_t face) { return side(face, point); });
  }

 private:
  [[nodiscard]] const LatticePoint& corner(std::size_t face, std::size_t i) const noexcept {
    return tet_[static_cast<std::size_t>(kFaceCorners[face][i])];
  }
  [[nodiscard]] int side(std::size_t face, const LatticePoint& point) const noexcept {
    const LatticePoint& p = corner(face, 0);
    double value = 0;
    double magnitude = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double term = normals_[face][k] * static_cast<double>(point[k] - p[k]);
      value += term;
      magnitude += std::abs(term);
    }
    // Each term carries four roundings, and the sum two more: less than 7 * 2^-53.
    if (std::abs(value) > 0x1p-49 * magnitude) return value > 0 ? 1 : -1;
    if (magnitude == 0) return 0;  // no term is rounded to 0: in faces along the grid, all are 0
    return sideOfFace(tet_, face, point);
  }

  const LatticeTet& tet_;
  std::array<Vec3, 4> normals_;  ///< of the faces, inwards, each component to within 2^-52
};

}  // namespace hexhex
