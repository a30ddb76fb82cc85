// Checks conditions (IGM2) to (IGM4) of Section 3.2.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <igm/map_conditions.hpp>

namespace hexhex::igm {

namespace {

/// Exact: coordinates are below 2^52.
TetParameters exactDoubles(const lattice::LatticeTet& corners) {
  TetParameters doubles{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) doubles[i][k] = static_cast<double>(corners[i][k]);
  }
  return doubles;
}

}  // namespace

std::size_t edgeAxis(const LocalParameters& parameters, const SingularEdge& edge) noexcept {
  return dominantAxis(
      minus(parameters(edge.tet, edge.corner1), parameters(edge.tet, edge.corner0)));
}

void checkBoundary(const RegularVertices& regular, const LocalParameters& parameters,
                   double tolerance, Stage& stage, DefectCollector& defects) {
  parallelFor(stage, regular.boundaryFaces.size(), 1, [&](std::size_t block) {
    for (const RegularVertices::BoundaryFace& face : regular.boundaryFaces[block]) {
      const std::size_t axis = face.axis;
      const adjacency::HalfFace halfFace = face.halfFace;
      std::array<double, 3> x{};
      for (std::size_t k = 0; k < 3; ++k) {
        x[k] = parameters(adjacency::tetOf(halfFace), lattice::kFaceCorners[halfFace % 4][k])[axis];
      }
      const double plane = nearestInteger((x[0] + x[1] + x[2]) / 3);
      const double off = std::max(std::max(std::abs(x[0] - plane), std::abs(x[1] - plane)),
                                  std::abs(x[2] - plane));
      if (off > tolerance) {
        defects.add(ErrorCode::BoundaryOffLattice,
                    {PlaceKind::Face, adjacency::tetOf(halfFace), halfFace % 4}, off);
      }
    }
  });
}

void checkSingularities(const Singularities& singularities, const LocalParameters& parameters,
                        double tolerance, DefectCollector& defects) {
  for (const SingularEdge& edge : singularities.edges) {
    const std::size_t along = edgeAxis(parameters, edge);
    const Vec3 p = parameters(edge.tet, edge.corner0);
    const Vec3 q = parameters(edge.tet, edge.corner1);
    double off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == along) continue;
      const double line = std::nearbyint((p[k] + q[k]) / 2);
      off = std::max({off, std::abs(p[k] - line), std::abs(q[k] - line)});
    }
    if (off > tolerance) {
      defects.add(ErrorCode::SingularityOffLattice, {PlaceKind::Edge, edge.vertex0, edge.vertex1},
                  off);
    }
  }
}

double leastCertainDeterminant(const LocalParameters& parameters, double unit) noexcept {
  // Each of the six products of three factors carries at most five roundings of relative size
  // 2^-53: together less than 31 * 2^-53.
  const double size = (parameters.largestExtent() + 1) * unit;
  return 0x1p-47 * size * size * size;
}

void checkOrientations(std::span<const std::vector<Index>> tets, const LocalParameters& parameters,
                       Stage& stage, DefectCollector& defects, const ExactMap& map) {
  const auto unit = static_cast<double>(map.unit);
  const double enough = map.maxDisplacement <= 0.5 ? leastCertainDeterminant(parameters, unit)
                                                   : std::numeric_limits<double>::infinity();
  parallelFor(stage, tets.size(), 1, [&](std::size_t block) {
    for (const Index t : tets[block]) {
      const lattice::LatticeTet& c = map.corners[t];
      if (isPositive(exactDoubles(c), enough) || lattice::orientation(c[0], c[1], c[2], c[3]) > 0)
        continue;
      const double amount = lattice::orientationDeterminant(c[0], c[1], c[2], c[3]).toDouble() /
                            (6 * unit * unit * unit);
      defects.add(ErrorCode::FlippedTet, {PlaceKind::Tet, t}, amount < 0 ? -amount : 0.0);
    }
  });
}

}  // namespace hexhex::igm
