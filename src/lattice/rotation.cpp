// The rotations as AlgoHex numbers them.
#include <lattice/rotation.hpp>

namespace hexhex::lattice {

namespace {

/// Twice the components (w, x, y, z) of AlgoHex's unit quaternions, times sqrt(2) where two are
/// set; only their ratios matter.
constexpr std::array<std::array<int, 4>, Rotation::kCount> kQuaternions = {{
    {1, 0, 0, 0},  {0, 1, 0, 0},   {0, 0, 1, 0},  {0, 0, 0, 1},   {1, 1, 0, 0},   {1, -1, 0, 0},
    {1, 0, 1, 0},  {1, 0, -1, 0},  {1, 0, 0, 1},  {1, 0, 0, -1},  {0, 1, 1, 0},   {0, 0, 1, 1},
    {0, 1, 0, 1},  {0, -1, 1, 0},  {0, 0, -1, 1}, {0, 1, 0, -1},  {1, 1, 1, 1},   {1, 1, 1, -1},
    {1, 1, -1, 1}, {1, 1, -1, -1}, {1, -1, 1, 1}, {1, -1, 1, -1}, {1, -1, -1, 1}, {1, -1, -1, -1},
}};

/// Column `axis` of the rotation matrix of a quaternion with integer components, as a direction.
Direction rotatedAxis(const std::array<int, 4>& q, std::size_t axis) {
  const int w = q[0];
  const std::array<int, 3> v = {q[1], q[2], q[3]};
  const int squaredNorm = w * w + v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  // R e = ((w^2 - |v|^2) e + 2 (v.e) v + 2 w (v x e)) / |q|^2
  std::array<int, 3> image = {2 * v[axis] * v[0], 2 * v[axis] * v[1], 2 * v[axis] * v[2]};
  image[axis] += 2 * w * w - squaredNorm;
  image[(axis + 1) % 3] += 2 * w * v[(axis + 2) % 3];
  image[(axis + 2) % 3] -= 2 * w * v[(axis + 1) % 3];
  for (int k = 0; k < 3; ++k) {
    if (image[static_cast<std::size_t>(k)] != 0) {
      return direction(k, image[static_cast<std::size_t>(k)]);
    }
  }
  return 0;
}

}  // namespace

Rotation rotationFromAlgoHex(int index) {
  const std::array<int, 4>& q = kQuaternions[static_cast<std::size_t>(index)];
  return Rotation::fromAxes(rotatedAxis(q, 0), rotatedAxis(q, 1)).inverse();
}

}  // namespace hexhex::lattice
