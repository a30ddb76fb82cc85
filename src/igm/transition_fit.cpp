#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <base/branchless.hpp>
#include <base/vector3.hpp>
#include <igm/best_rotation.hpp>
#include <igm/transition_fit.hpp>
#include <igm/turn.hpp>

namespace hexhex {

namespace {

double distance(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// The three corners of a triangle in the charts of both its tets.
struct SharedTriangle {
  std::array<Vec3, 3> here;
  std::array<Vec3, 3> there;
};

SharedTriangle sharedTriangle(const TetTopology& topology, const LocalParameters& parameters,
                              HalfFace here, HalfFace there) {
  const SharedFace face(topology, here, there);
  SharedTriangle triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    triangle.here[k] = parameters.at(tetOf(here), face.here(k));
    triangle.there[k] = parameters.at(tetOf(there), face.there(k));
  }
  return triangle;
}

Rotation rotationOf(const SharedTriangle& triangle) {
  return bestRotation(
      {minus(triangle.here[1], triangle.here[0]), minus(triangle.here[2], triangle.here[0])},
      {minus(triangle.there[1], triangle.there[0]), minus(triangle.there[2], triangle.there[0])});
}

/// What remains when a transition carries corners over.
double residualOf(const SharedTriangle& triangle, const std::array<Vec3, 3>& images,
                  const Vec3& translation) {
  double residual = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    residual = std::max(residual, distance(triangle.there[i], plus(images[i], translation)));
  }
  return residual;
}

/// The integers nearest to the mean of what is left of the corners after the rotation.
Vec3 meanTranslation(const SharedTriangle& triangle, const std::array<Vec3, 3>& images) {
  Vec3 mean{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 difference = minus(triangle.there[i], images[i]);
    for (std::size_t k = 0; k < 3; ++k) mean[k] += difference[k] / 3;
  }
  for (double& component : mean) component = nearestInteger(component);
  return mean;
}

/// Whether nothing is rounded when corners are moved by a translation that leaves no residual.
bool isExact(const SharedTriangle& triangle, const std::array<Vec3, 3>& images,
             const Vec3& translation) {
  double rest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      rest += restOfSum(triangle.there[i][k], images[i][k], translation[k]);
    }
  }
  return rest == 0;
}

FittedTransition fitTranslation(const SharedTriangle& triangle, Rotation rotation) {
  std::array<Vec3, 3> images{};
  for (std::size_t i = 0; i < 3; ++i) images[i] = turned(rotation, triangle.here[i]);
  Vec3 translation = minus(triangle.there[0], images[0]);
  for (double& component : translation) component = nearestInteger(component);
  FittedTransition fitted;
  fitted.residual = residualOf(triangle, images, translation);
  // If it fits each corner to within a quarter, it is what the mean is nearest to.
  if (fitted.residual > 0.25) {
    translation = meanTranslation(triangle, images);
    fitted.residual = residualOf(triangle, images, translation);
  }
  fitted.isExact = fitted.residual == 0 && isExact(triangle, images, translation);
  fitted.transition.rotation = rotation;
  for (std::size_t k = 0; k < 3; ++k) {
    fitted.transition.translation[k] = static_cast<std::int32_t>(translation[k]);
  }
  return fitted;
}

}  // namespace

bool agree(const TetTopology& topology, const LocalParameters& parameters, HalfFace here,
           HalfFace there) {
  const SharedFace face(topology, here, there);
  for (std::size_t k = 0; k < 3; ++k) {
    if (parameters.at(tetOf(here), face.here(k)) != parameters.at(tetOf(there), face.there(k))) {
      return false;
    }
  }
  return true;
}

FittedTransition fitTransition(const TetTopology& topology, const LocalParameters& parameters,
                               HalfFace here, HalfFace there) {
  const SharedTriangle triangle = sharedTriangle(topology, parameters, here, there);
  return fitTranslation(triangle, rotationOf(triangle));
}

FittedTransition fitTransition(const TetTopology& topology, const LocalParameters& parameters,
                               HalfFace here, HalfFace there, Rotation rotation) {
  return fitTranslation(sharedTriangle(topology, parameters, here, there), rotation);
}

}  // namespace hexhex
