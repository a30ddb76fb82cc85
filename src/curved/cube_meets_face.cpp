#include <algorithm>

#include <curved/cube_meets_face.hpp>

namespace hexhex {

namespace {

using Triangle = std::array<LatticePoint, 3>;

bool separatedByCube(const Triangle& t, std::int64_t unit) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({t[0][k], t[1][k], t[2][k]});
    if (low >= unit || high <= 0) return true;
  }
  return false;
}

/// Along the cross product of cube edge k and a triangle edge d.
bool separatedByEdges(const Triangle& t, const LatticePoint& d, std::size_t k,
                      std::int64_t unit) noexcept {
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  if (d[i] == 0 && d[j] == 0) return false;  // parallel edges have no cross product
  // The function d_i x_j - d_j x_i of a point x.
  const auto at = [&](const LatticePoint& x) {
    return static_cast<Int128>(d[i]) * x[j] - static_cast<Int128>(d[j]) * x[i];
  };
  const auto [low, high] = std::minmax({at(t[0]), at(t[1]), at(t[2])});
  const Int128 alongJ = static_cast<Int128>(d[i]) * unit;
  const Int128 alongI = -static_cast<Int128>(d[j]) * unit;
  const Int128 zero = 0;
  const Int128 cubeLow = std::min(alongI, zero) + std::min(alongJ, zero);
  const Int128 cubeHigh = std::max(alongI, zero) + std::max(alongJ, zero);
  return low >= cubeHigh || high <= cubeLow;
}

bool separatedByTriangle(const Triangle& t, std::int64_t unit) noexcept {
  const LatticePoint u = t[1] - t[0];
  const LatticePoint v = t[2] - t[0];
  // The normal's product with (corner of the cube) - (corner of the triangle): the cube is on one
  // side if its two extreme corners are.
  Int192 lowest;
  Int192 highest;
  for (std::size_t k = 0; k < 3; ++k) {
    const Int128 normal = crossComponent(u, v, k);
    lowest.addProduct(normal, (normal < 0 ? unit : 0) - t[0][k]);
    highest.addProduct(normal, (normal > 0 ? unit : 0) - t[0][k]);
  }
  return lowest.sign() >= 0 || highest.sign() <= 0;
}

}  // namespace

bool cubeMeetsFace(const LatticeTet& corners, int face, std::int64_t unit) noexcept {
  Triangle t{};
  for (std::size_t i = 0; i < 3; ++i) {
    t[i] = corners[static_cast<std::size_t>(kFaceCorners[static_cast<std::size_t>(face)][i])];
  }
  if (separatedByCube(t, unit)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticePoint d = t[(i + 1) % 3] - t[i];
    for (std::size_t k = 0; k < 3; ++k) {
      if (separatedByEdges(t, d, k, unit)) return false;
    }
  }
  return !separatedByTriangle(t, unit);
}

}  // namespace hexhex
