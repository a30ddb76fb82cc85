// Rotations of the cube as signed permutations, and motions of the integer grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hexhex::samples {

/// A point or vector with integer coordinates.
using Int3 = std::array<std::int64_t, 3>;

inline Int3 operator+(const Int3& a, const Int3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Int3 operator-(const Int3& a, const Int3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Int3 operator*(std::int64_t factor, const Int3& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

/// A coordinate axis with a sign of +1 or -1.
struct Direction {
  std::size_t axis = 0;
  int sign = 1;
};

/// A rotation of the cube: the directions onto which the three positive axes turn.
struct Rotation {
  std::array<Direction, 3> image = {{{0, 1}, {1, 1}, {2, 1}}};

  Int3 operator()(const Int3& v) const {
    Int3 turned{};
    for (std::size_t a = 0; a < 3; ++a) turned[image[a].axis] = image[a].sign * v[a];
    return turned;
  }
  Direction operator()(const Direction& direction) const {
    const Direction turned = image[direction.axis];
    return {turned.axis, direction.sign * turned.sign};
  }
};

/// First `inner`, then `outer`.
inline Rotation compose(const Rotation& outer, const Rotation& inner) {
  Rotation both;
  for (std::size_t a = 0; a < 3; ++a) both.image[a] = outer(inner.image[a]);
  return both;
}

inline Rotation inverse(const Rotation& rotation) {
  Rotation back;
  for (std::size_t a = 0; a < 3; ++a) {
    back.image[rotation.image[a].axis] = {a, rotation.image[a].sign};
  }
  return back;
}

/// +1 for a rotation, -1 for a reflection.
inline int determinant(const Rotation& rotation) {
  const auto& image = rotation.image;
  const bool cyclic = (image[0].axis + 1) % 3 == image[1].axis;
  return (cyclic ? 1 : -1) * image[0].sign * image[1].sign * image[2].sign;
}

/// The rotations of the cube, numbered 0 to 23; 0 is the identity.
inline Rotation cubeRotation(std::uint64_t number) {
  const std::size_t first = number / 8;                           // image axis of x
  const std::size_t second = (first + 1 + (number / 4) % 2) % 3;  // image axis of y
  Rotation rotation;
  rotation.image[0] = {first, number % 2 == 0 ? 1 : -1};
  rotation.image[1] = {second, (number / 2) % 2 == 0 ? 1 : -1};
  rotation.image[2] = {3 - first - second, 1};
  rotation.image[2].sign = determinant(rotation);
  return rotation;
}

/// x -> rotation(x) + translation.
struct Motion {
  Rotation rotation;
  Int3 translation{};

  Int3 operator()(const Int3& point) const { return rotation(point) + translation; }
};

/// First `inner`, then `outer`.
inline Motion compose(const Motion& outer, const Motion& inner) {
  return {compose(outer.rotation, inner.rotation), outer(inner.translation)};
}

inline Motion inverse(const Motion& motion) {
  const Rotation back = inverse(motion.rotation);
  return {back, Int3{} - back(motion.translation)};
}

}  // namespace hexhex::samples
