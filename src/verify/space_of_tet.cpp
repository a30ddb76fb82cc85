#include <algorithm>
#include <cmath>

#include <verify/space_of_tet.hpp>

#include <base/vector3.hpp>

namespace hexhex::verification {

namespace {

/// What a position may err by, relative to the coordinates of its tet: a few roundings, and the
/// conversion to text with 17 digits.
constexpr double kSpaceOfTetRounding = 0x1p-48;
/// Weights that lose more digits than this are computed exactly. Extraction does so from 2^20 on,
/// as it measures it, which is at least a sixth of what is measured here.
constexpr double kMaxCondition = 0x1p23;

}  // namespace

SpaceOfTet::SpaceOfTet(const igm::PreparedMap& map, Index tet)
    : corners_(map.exact.corners[tet]), unit_(map.exact.unit) {
  const double perUnit = 1.0 / static_cast<double>(unit_);
  double largest = 0;
  Vec3 extent{};
  for (std::size_t i = 0; i < 4; ++i) {
    points_[i] = map.input.view.points[map.topology.tets[tet][i]];
    for (std::size_t k = 0; k < 3; ++k) {
      largest = std::max(largest, std::abs(points_[i][k]));
      extent[k] = std::max(
          extent[k], std::abs(static_cast<double>(corners_[i][k] - corners_[0][k])) * perUnit);
    }
  }
  std::array<Vec3, 3> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges[i][k] = static_cast<double>(corners_[i + 1][k] - corners_[0][k]) * perUnit;
    }
  }
  // Weight i + 1 of a point u is normals[i] . (u - corner 0) / determinant.
  const std::array<Vec3, 3> normals = {cross(edges[1], edges[2]), cross(edges[2], edges[0]),
                                       cross(edges[0], edges[1])};
  const double determinant = dot(edges[0], normals[0]);
  double condition = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = static_cast<std::int32_t>(corners_[0][k] / unit_);
    for (std::size_t i = 0; i < 3; ++i) {
      condition += std::abs(normals[i][k]) * (extent[k] + 1);
      for (std::size_t j = 0; j < 3; ++j) {
        steps_[k][j] += (points_[i + 1][j] - points_[0][j]) * (normals[i][k] / determinant);
      }
    }
  }
  condition = 1 + condition / determinant;
  isFlat_ = !(determinant > 0) || !(condition < kMaxCondition);
  // Below 2^-1022, numbers lose digits.
  error_ = largest * kSpaceOfTetRounding * (isFlat_ ? 1 : condition) +
           0x1p-1070 * (8 + extent[0] + extent[1] + extent[2]);
  atOrigin_ = points_[0];
  for (std::size_t k = 0; k < 3; ++k) {
    const double offset = static_cast<double>(origin_[k] * unit_ - corners_[0][k]) * perUnit;
    for (std::size_t j = 0; j < 3; ++j) atOrigin_[j] += steps_[k][j] * offset;
  }
}

Vec3 SpaceOfTet::preimage(const lattice::GridPoint& z) const {
  Vec3 q = atOrigin_;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto offset = static_cast<double>(z[k] - origin_[k]);
    for (std::size_t j = 0; j < 3; ++j) q[j] += steps_[k][j] * offset;
  }
  return q;
}

/// With exact weights, each rounded once.
Vec3 SpaceOfTet::exactly(const lattice::GridPoint& z) const {
  const lattice::LatticePoint u = {z[0] * unit_, z[1] * unit_, z[2] * unit_};
  std::array<double, 4> weights{};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::array<int, 3>& f = lattice::kFaceCorners[i];
    weights[i] = lattice::orientationDeterminant(corners_[static_cast<std::size_t>(f[0])],
                                                 corners_[static_cast<std::size_t>(f[1])],
                                                 corners_[static_cast<std::size_t>(f[2])], u)
                     .toDouble();
    sum += weights[i];
  }
  Vec3 q{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 3; ++j) q[j] += points_[i][j] * (weights[i] / sum);
  }
  return q;
}

}  // namespace hexhex::verification
