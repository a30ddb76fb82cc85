#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <adjacency/cell_faces.hpp>

#include <base/vector3.hpp>
#include <improve/reference_surface.hpp>
#include <improve/worst_cell.hpp>
#include <mesh/cell_measures.hpp>

namespace hexhex::improvement {

namespace {

/// A corner of a cell: its vertex, and those at the ends of its three edges, right-handed.
struct CellCorner {
  std::size_t cell = 0;  ///< index of a straight cell
  Index vertex = kNone;
  std::array<Index, 3> ends{};
};

CellCorner cornerAt(const HexMesh& mesh, std::size_t cell, std::size_t place) {
  const auto at = [&](std::size_t p) { return mesh.cells[cell][mesh::kVtkCorner[p]]; };
  CellCorner corner{cell, at(place), {at(place ^ 1U), at(place ^ 2U), at(place ^ 4U)}};
  const bool isOdd = place == 1 || place == 2 || place == 4 || place == 7;
  if (isOdd) std::swap(corner.ends[0], corner.ends[1]);
  return corner;
}

std::array<Vec3, 3> edgeVectors(const HexMesh& mesh, const CellCorner& corner) {
  std::array<Vec3, 3> edges{};
  for (std::size_t k = 0; k < 3; ++k) {
    edges[k] = minus(mesh.points[corner.ends[k]], mesh.points[corner.vertex]);
  }
  return edges;
}

double scaledJacobian(const std::array<Vec3, 3>& edges) {
  const double lengths = length(edges[0]) * length(edges[1]) * length(edges[2]);
  return lengths > 0 ? tripleProduct(edges[0], edges[1], edges[2]) / lengths : 0;
}

/// The angle around an edge in degrees, from one face to the other.
double angleAround(const Vec3& edge, const Vec3& from, const Vec3& to) {
  const Vec3 a = cross(edge, from);
  const Vec3 b = cross(edge, to);
  const double angle =
      std::atan2(dot(cross(a, b), edge) / std::max(length(edge), 1e-300), dot(a, b)) * 180 /
      std::numbers::pi;
  return angle < 0 ? angle + 360 : angle;
}

/// Whether the face of a cell that has these vertices is on the boundary.
bool isOnBoundary(const HexMesh& mesh, const Boundary& boundary, std::size_t cell,
                  const std::array<Index, 3>& vertices) {
  for (std::size_t face = 0; face < adjacency::kHexFaces.size(); ++face) {
    const Quad quad = adjacency::faceVertices(mesh.cells[cell], face);
    const bool hasAll = std::all_of(vertices.begin(), vertices.end(), [&](Index v) {
      return std::find(quad.begin(), quad.end(), v) != quad.end();
    });
    if (hasAll)
      return std::binary_search(boundary.faces.begin(), boundary.faces.end(), 8 * cell + face);
  }
  return false;
}

}  // namespace

WorstCell worstCell(const Subject& subject, const Boundary& boundary, const VertexPlaces& places,
                    const ImproveReport& report) {
  const HexMesh& mesh = subject.mesh;
  const Array<double>& qualities = report.after.scaledJacobians;
  WorstCell worst;
  worst.cell = static_cast<std::uint64_t>(std::min_element(qualities.begin(), qualities.end()) -
                                          qualities.begin());
  CellCorner corner;
  double least = 2;
  for (std::size_t c = worst.cell * subject.parts(); c < (worst.cell + 1) * subject.parts(); ++c) {
    for (std::size_t place = 0; place < 8; ++place) {
      const CellCorner candidate = cornerAt(mesh, c, place);
      const double scaled = scaledJacobian(edgeVectors(mesh, candidate));
      if (scaled >= least) continue;
      least = scaled;
      corner = candidate;
    }
  }
  worst.vertex = corner.vertex;
  constexpr double kRight = 90;
  const std::array<Vec3, 3> edges = edgeVectors(mesh, corner);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const std::size_t last = (k + 2) % 3;
    const auto isOnBoundaryWith = [&](std::size_t other) {
      return isOnBoundary(mesh, boundary, corner.cell,
                          {corner.vertex, corner.ends[k], corner.ends[other]});
    };
    if (!isOnBoundaryWith(next) || !isOnBoundaryWith(last)) continue;
    const double angle = angleAround(edges[k], edges[next], edges[last]);
    if (worst.angle == 0 || std::abs(angle - kRight) > std::abs(worst.angle - kRight)) {
      worst.angle = angle;
    }
  }
  const Freedom freedom = places.freedom[corner.vertex];
  const Index simplex = places.simplex[corner.vertex];
  const auto& paired = report.cannotBePositive;
  if (std::binary_search(paired.begin(), paired.end(), worst.cell)) {
    worst.holder = CellHolder::SharedFaces;
  } else if (freedom == Freedom::Fixed) {
    worst.holder = simplex == kNone ? CellHolder::Held : CellHolder::Corner;
  } else if (worst.angle > 0) {
    worst.holder = freedom == Freedom::OnCurve ? CellHolder::Curve : CellHolder::Surface;
  }
  worst.isTagged = (worst.holder == CellHolder::Corner || worst.holder == CellHolder::Curve) &&
                   places.surface.isTagged(freedom, simplex);
  return worst;
}

}  // namespace hexhex::improvement
