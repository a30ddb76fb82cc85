// Inverts the map in one tet, at grid points.
#include <algorithm>
#include <cmath>

#include <base/vector3.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex::sweep {

namespace {

/// The affine form may lose this factor in precision; beyond that, weights are computed exactly.
constexpr double kMaxCondition = 0x1p20;

Vec3 toVector(const lattice::LatticePoint& p, double scale) {
  return {static_cast<double>(p[0]) * scale, static_cast<double>(p[1]) * scale,
          static_cast<double>(p[2]) * scale};
}

void addScaled(Vec3& sum, const Vec3& v, double factor) {
  for (std::size_t k = 0; k < 3; ++k) sum[k] += factor * v[k];
}

}  // namespace

TetPositions::TetPositions(const igm::PreparedMap& map, Index tet, lattice::SweepAxes axes)
    : corners_(map.exact.corners[tet]), unit_(map.exact.unit), axes_(axes()) {
  const lattice::GridBox box = lattice::gridBox(corners_, unit_);
  for (std::size_t i = 0; i < 4; ++i) points_[i] = map.input.view.points[map.topology.tets[tet][i]];
  lattice::LatticePoint boxOrigin{};
  Vec3 extent{};
  for (std::size_t k = 0; k < 3; ++k) {
    first_[k] = box.range[axes_[k]].first;
    boxOrigin[axes_[k]] = first_[k] * unit_;
    extent[axes_[k]] = static_cast<double>(box.range[axes_[k]].last - first_[k]) + 1;
  }
  const double scale = 1.0 / static_cast<double>(unit_);
  const std::array<Vec3, 3> edges = {toVector(corners_[1] - corners_[0], scale),
                                     toVector(corners_[2] - corners_[0], scale),
                                     toVector(corners_[3] - corners_[0], scale)};
  // Weight i of a point z is normals[i] . (z - corner 0) / determinant.
  const std::array<Vec3, 3> normals = {cross(edges[1], edges[2]), cross(edges[2], edges[0]),
                                       cross(edges[0], edges[1])};
  const double determinant = dot(edges[0], normals[0]);
  double condition = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double sum = std::abs(normals[0][k]) + std::abs(normals[1][k]) + std::abs(normals[2][k]);
    condition = std::max(condition, sum * extent[k] / determinant);
  }
  if (!(determinant > 0) || !(condition < kMaxCondition)) {
    illConditioned_ = true;
    return;
  }
  const Vec3 offset = toVector(boxOrigin - corners_[0], scale);
  origin_ = points_[0];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t axis = axes_[k];
    for (std::size_t i = 0; i < 3; ++i) {
      addScaled(steps_[k], minus(points_[i + 1], points_[0]), normals[i][axis] / determinant);
    }
    addScaled(origin_, steps_[k], offset[axis]);
  }
}

Vec3 TetPositions::at(lattice::CornerMask simplex, const lattice::GridPoint& z) const {
  switch (lattice::dimension(simplex)) {
    case 0:
      return points_[lattice::firstCorner(simplex)];
    case 1:
      return onEdge(simplex, z);
    case 2:
      return onFace(simplex, z);
    default:
      return inside(z[axes_[0]], z[axes_[1]], z[axes_[2]]);
  }
}

void TetPositions::alongLine(std::int32_t level, std::int32_t row, std::int32_t first,
                             std::uint32_t count, Vec3* positions) const {
  if (illConditioned_) {
    for (std::uint32_t i = 0; i < count; ++i) {
      positions[i] = inside(level, row, first + static_cast<std::int32_t>(i));
    }
    return;
  }
  const Vec3 base = rowOrigin(level, row);
  auto w = static_cast<double>(first - first_[2]);
  for (std::uint32_t i = 0; i < count; ++i, w += 1) {
    for (std::size_t k = 0; k < 3; ++k) positions[i][k] = base[k] + w * steps_[2][k];
  }
}

Vec3 TetPositions::rowOrigin(std::int32_t level, std::int32_t row) const {
  const auto u = static_cast<double>(level - first_[0]);
  const auto v = static_cast<double>(row - first_[1]);
  Vec3 p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = (origin_[k] + u * steps_[0][k]) + v * steps_[1][k];
  return p;
}

Vec3 TetPositions::inside(std::int32_t level, std::int32_t row, std::int32_t point) const {
  if (illConditioned_) {
    lattice::GridPoint z{};
    z[axes_[0]] = level;
    z[axes_[1]] = row;
    z[axes_[2]] = point;
    return insideExactly(z);
  }
  Vec3 p = rowOrigin(level, row);
  const auto w = static_cast<double>(point - first_[2]);
  for (std::size_t k = 0; k < 3; ++k) p[k] += w * steps_[2][k];
  return p;
}

Vec3 TetPositions::insideExactly(const lattice::GridPoint& z) const {
  const lattice::LatticePoint point = {z[0] * unit_, z[1] * unit_, z[2] * unit_};
  std::array<double, 4> weights{};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::array<int, 3>& face = lattice::kFaceCorners[i];
    weights[i] = lattice::orientationDeterminant(corners_[static_cast<std::size_t>(face[0])],
                                                 corners_[static_cast<std::size_t>(face[1])],
                                                 corners_[static_cast<std::size_t>(face[2])], point)
                     .toDouble();
  }
  return combine(weights);
}

/// Weights from areas in the projection along an axis that shows the face largest.
Vec3 TetPositions::onFace(lattice::CornerMask face, const lattice::GridPoint& z) const {
  const std::array<int, 3>& f =
      lattice::kFaceCorners[static_cast<std::size_t>(lattice::oppositeCorner(face))];
  std::array<lattice::LatticePoint, 3> relative{};
  for (std::size_t i = 0; i < 3; ++i) {
    const lattice::LatticePoint& corner = corners_[static_cast<std::size_t>(f[i])];
    relative[i] = {corner[0] - z[0] * unit_, corner[1] - z[1] * unit_, corner[2] - z[2] * unit_};
  }
  std::size_t axis = 0;
  lattice::Int128 largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const lattice::Int128 area =
        lattice::crossComponent(relative[1] - relative[0], relative[2] - relative[0], k);
    if ((area < 0 ? -area : area) <= largest) continue;
    largest = area < 0 ? -area : area;
    axis = k;
  }
  std::array<double, 4> weights{};
  for (std::size_t i = 0; i < 3; ++i) {
    const lattice::Int128 area =
        lattice::crossComponent(relative[(i + 1) % 3], relative[(i + 2) % 3], axis);
    weights[static_cast<std::size_t>(f[i])] = lattice::toDouble(area < 0 ? -area : area);
  }
  return combine(weights);
}

/// Weights from the edge's largest extent.
Vec3 TetPositions::onEdge(lattice::CornerMask edge, const lattice::GridPoint& z) const {
  const std::size_t a = lattice::firstCorner(edge);
  const std::size_t b = lattice::lastCorner(edge);
  const lattice::LatticePoint along = corners_[b] - corners_[a];
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(along[k]) > std::abs(along[axis])) axis = k;
  }
  const std::int64_t at = z[axis] * unit_;
  std::array<double, 4> weights{};
  weights[a] = std::abs(static_cast<double>(corners_[b][axis] - at));
  weights[b] = std::abs(static_cast<double>(at - corners_[a][axis]));
  return combine(weights);
}

Vec3 TetPositions::combine(const std::array<double, 4>& weights) const {
  const double sum = weights[0] + weights[1] + weights[2] + weights[3];
  Vec3 p{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (weights[i] != 0) addScaled(p, points_[i], weights[i] / sum);
  }
  return p;
}

}  // namespace hexhex::sweep
