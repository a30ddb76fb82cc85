// Where labels wind around the sphere of directions otherwise than the surface does.
#pragma once

#include <array>
#include <vector>

#include <shape/label_costs.hpp>

namespace hexhex::shape {

/// Around a vertex, normals run around a part of the sphere whose area is the curvature (Gauss),
/// and labels around another one. On the shortest way from the former to the latter, they sweep the
/// difference, up to whole spheres. For labels of a polycube, these add up to 0 over a closed
/// surface (Gauss, Bonnet): otherwise a face would have to turn too often, whatever its labels.
/// Mostly a single vertex is to blame: at the end of a groove, all normals face away from their
/// label.
class LabelWinding {
 public:
  /// @param surface  must outlive this
  explicit LabelWinding(const Surface& surface);

  /// @return per vertex: the number of spheres, positive if counterclockwise; meaningless at edges
  ///         between opposite labels
  [[nodiscard]] const std::vector<double>& operator()(const Labels& labels);

 private:
  [[nodiscard]] double areaAround(const Labels& labels, Side border) const;

  const Surface& surface_;
  std::vector<double> curvature_;  ///< per vertex
  /// Per side, the smaller one of two twins: the area between both normals and a label.
  std::vector<std::array<double, lattice::kDirections>> swept_;
  std::vector<Side> borders_;
  std::vector<int> borderCount_;  ///< per vertex
  std::vector<double> spheres_;   ///< per vertex
};

}  // namespace hexhex::shape
