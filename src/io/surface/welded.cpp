#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

#include <io/surface/surface.hpp>

namespace hexhex::io {

TriangleMesh welded(const TriangleMesh& mesh) {
  if (mesh.points.size() >= kNone) {
    throw Error(ErrorCode::TooLarge, "The surface has more vertices than can be numbered.");
  }
  std::vector<Index> order(mesh.points.size());
  std::iota(order.begin(), order.end(), Index{0});
  // Equal points are represented by the first of them.
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const Vec3& p = mesh.points[a];
    const Vec3& q = mesh.points[b];
    return p == q ? a < b : p < q;
  });
  std::vector<Index> first(mesh.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool isNew = i == 0 || mesh.points[order[i]] != mesh.points[order[i - 1]];
    first[order[i]] = isNew ? order[i] : first[order[i - 1]];
  }
  TriangleMesh result;
  std::vector<Index> vertices(mesh.points.size());
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (first[v] == v) {
      vertices[v] = static_cast<Index>(result.points.size());
      result.points.push_back(mesh.points[v]);
    } else {
      vertices[v] = vertices[first[v]];
    }
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<Index, 3> t = {vertices[a], vertices[b], vertices[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
  }
  return result;
}

}  // namespace hexhex::io
