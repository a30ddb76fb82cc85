#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <view/cut_tets.hpp>

namespace hexhex::view {
namespace {

/// The corners of a tet, seen from each: an even permutation, so that hexahedra are positive where
/// the tet is.
constexpr std::array<std::array<std::size_t, 4>, 4> kSeenFrom = {
    {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}}};

/// Edges or triangles, each once, and where their points begin in the mesh.
template <std::size_t n>
class Simplices {
 public:
  using Vertices = std::array<Index, n>;

  explicit Simplices(const TetMesh& tets) {
    for (const Tet& tet : tets.tets) {
      for (const auto& seen : kSeenFrom) add(tet, seen);
    }
    sortUnique(all_);
  }

  void appendCentres(const TetMesh& tets, HexMesh& mesh) {
    begin_ = mesh.points.size();
    for (const Vertices& vertices : all_) {
      std::array<Vec3, n> corners;
      for (std::size_t i = 0; i < n; ++i) corners[i] = tets.points[vertices[i]];
      mesh.points.push_back(centreOf(corners));
    }
  }

  [[nodiscard]] Index pointOf(const Vertices& vertices) const {
    const auto found = std::lower_bound(all_.begin(), all_.end(), sorted(vertices));
    return static_cast<Index>(begin_ + static_cast<std::size_t>(found - all_.begin()));
  }

  [[nodiscard]] std::span<const Vertices> all() const { return all_; }

 private:
  void add(const Tet& tet, const std::array<std::size_t, 4>& seen) {
    for (std::size_t i = 1; i < 4; ++i) {
      Vertices vertices;
      vertices[0] = tet[seen[0]];
      for (std::size_t k = 1; k < n; ++k) vertices[k] = tet[seen[1 + (i + k - 2) % 3]];
      all_.push_back(sorted(vertices));
    }
  }

  std::vector<Vertices> all_;
  std::size_t begin_ = 0;
};

void requireVertices(const TetMesh& tets) {
  if (tets.tets.empty()) throw Error(ErrorCode::EmptyMesh, "There are no tets to show.");
  for (std::size_t t = 0; t < tets.tets.size(); ++t) {
    for (const Index v : tets.tets[t]) {
      if (v < tets.points.size()) continue;
      throw Error(ErrorCode::IndexOutOfRange,
                  "Tet " + std::to_string(t) + " names vertex " + std::to_string(v) +
                      ", but there are " + std::to_string(tets.points.size()) + ".",
                  {PlaceKind::Tet, t, 0});
    }
  }
}

bool isPositive(const TetMesh& tets, const Tet& tet) {
  const Vec3& from = tets.points[tet[0]];
  return tripleProduct(minus(tets.points[tet[1]], from), minus(tets.points[tet[2]], from),
                       minus(tets.points[tet[3]], from)) >= 0;
}

/// The vertices of a place, which may be none of the tets.
std::vector<Index> verticesAt(const TetMesh& tets, const Place& place) {
  if (place.kind == PlaceKind::Vertex) return {static_cast<Index>(place.index)};
  if (place.kind == PlaceKind::Edge) {
    return {static_cast<Index>(place.index), static_cast<Index>(place.second)};
  }
  const bool isInTet = place.kind == PlaceKind::Tet || place.kind == PlaceKind::Face;
  if (!isInTet || place.index >= tets.tets.size()) return {};
  std::vector<Index> vertices;
  for (std::size_t i = 0; i < 4; ++i) {
    if (place.kind == PlaceKind::Face && i == place.second) continue;
    vertices.push_back(tets.tets[place.index][i]);
  }
  return vertices;
}

}  // namespace

HexMesh cutTets(const TetMesh& tets, const Place& place) {
  requireVertices(tets);
  Simplices<2> edges(tets);
  Simplices<3> faces(tets);
  const std::vector<Index> at = verticesAt(tets, place);
  const auto isAt = [&at](Index vertex) {
    return std::find(at.begin(), at.end(), vertex) != at.end();
  };
  HexMesh mesh;
  mesh.points.assign(tets.points.begin(), tets.points.end());
  edges.appendCentres(tets, mesh);
  faces.appendCentres(tets, mesh);
  for (const Tet& given : tets.tets) {
    Tet tet = given;
    if (!isPositive(tets, tet)) std::swap(tet[2], tet[3]);
    const auto centre = static_cast<Index>(mesh.points.size());
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = tets.points[tet[i]];
    mesh.points.push_back(centreOf(corners));
    const std::int32_t region = std::any_of(tet.begin(), tet.end(), isAt) ? kAtPlace : kElsewhere;
    mesh.regions.insert(mesh.regions.end(), 4, region);
    for (const auto& seen : kSeenFrom) {
      const auto [v, a, b, c] = std::array{tet[seen[0]], tet[seen[1]], tet[seen[2]], tet[seen[3]]};
      mesh.cells.push_back({v, edges.pointOf({v, a}), faces.pointOf({v, a, b}),
                            edges.pointOf({v, b}), edges.pointOf({v, c}), faces.pointOf({v, a, c}),
                            centre, faces.pointOf({v, b, c})});
    }
  }
  const int leastAt = at.size() == 1 ? 1 : 2;
  for (const auto& edge : edges.all()) {
    if (std::count_if(edge.begin(), edge.end(), isAt) < leastAt) continue;
    for (const Index end : edge) mesh.features.edges.push_back({{end, edges.pointOf(edge)}, 1});
  }
  return mesh;
}

}  // namespace hexhex::view
