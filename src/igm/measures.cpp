#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>

#include <adjacency/tet_topology.hpp>

#include <base/disjoint_sets.hpp>
#include <igm/measures.hpp>

namespace hexhex {

namespace {

int unitBits(const ExactMap& map) { return std::countr_zero(static_cast<std::uint64_t>(map.unit)); }

/// sum / (divisor * 2^shift) as an integer.
std::uint64_t exactQuotient(const Int192& sum, int shift, unsigned divisor, const char* what) {
  bool exact = true;
  const UInt128 quotient = sum.shiftedRight(shift, exact);
  if (!exact || quotient % divisor != 0) {
    throw Error(ErrorCode::Internal, std::string("The parametric ") + what +
                                         " of the sanitized map is not an integer. This is a bug; "
                                         "please report it with the map.");
  }
  return static_cast<std::uint64_t>(quotient / divisor);
}

/// A face of a tet in its chart.
struct LatticeTriangle {
  LatticePoint origin;
  LatticePoint a;  ///< edges from there
  LatticePoint b;

  LatticeTriangle(const ExactMap& map, HalfFace halfFace) {
    const LatticeTet& corners = map.corners[tetOf(halfFace)];
    const auto corner = [&](std::size_t k) {
      return corners[static_cast<std::size_t>(kFaceCorners[halfFace % 4][k])];
    };
    origin = corner(0);
    a = corner(1) - origin;
    b = corner(2) - origin;
  }
  /// A component of the normal, which leads into the tet.
  [[nodiscard]] Int128 normal(std::size_t axis) const noexcept {
    return crossComponent(a, b, axis);
  }
};

/// The boundary half-face across an edge of a boundary half-face, around the tets between them.
HalfFace acrossBoundaryEdge(const TetTopology& topology, HalfFace halfFace, CornerMask edge) {
  EdgeTurn turn(topology, tetOf(halfFace), edge, otherFaceAtEdge(edge, localOf(halfFace)));
  while (turn.next() != kNone) turn.step();
  return turn.out();
}

}  // namespace

/// The volume of a tet is the sum of those between its faces and the origin. They cancel at inner
/// faces, but for what the transition makes of it: if it is a translation by t after a rotation,
/// then the scalar product of t with the triangle's normal is left.
Int192 sixfoldVolume(const RegularVertices& survey, const ExactMap& map, Stage& stage) {
  const Transitions& transitions = map.transitions;
  std::vector<Int192> sums(survey.boundaryFaces.size());
  parallelFor(stage, sums.size(), 1, [&](std::size_t block) {
    Int192 sum;
    for (const RegularVertices::BoundaryFace& face : survey.boundaryFaces[block]) {
      const LatticeTriangle triangle(map, face.halfFace);
      // Its plane is axis-parallel, and so is the normal.
      sum.addProduct(triangle.normal(face.axis), -triangle.origin[face.axis]);
    }
    for (const HalfFace halfFace : survey.unequalFaces[block]) {
      const Index back = Transitions::inverse(transitions.ofFace[halfFace]);
      const GridPoint& translation = transitions.table[back].translation;
      const LatticeTriangle triangle(map, halfFace);
      for (std::size_t k = 0; k < 3; ++k) {
        sum.addProduct(triangle.normal(k), -translation[k] * map.unit);
      }
    }
    sums[block] = sum;
  });
  Int192 volume;
  for (const Int192& sum : sums) volume += sum;
  return volume;
}

std::uint64_t parametricVolume(const ExactMap& map) {
  return exactQuotient(map.sixfoldVolume, 3 * unitBits(map), 6, "volume");
}

std::uint64_t boundaryArea(const TetTopology& topology, const ExactMap& map) {
  Int192 sum;
  for (HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    if (!topology.isBoundary(halfFace)) continue;
    const LatticeTriangle triangle(map, halfFace);
    // It lies in a grid plane: one component of its normal is not zero.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Int128 component = triangle.normal(axis);
      sum += Int192(component < 0 ? -component : component);
    }
  }
  return exactQuotient(sum, 2 * unitBits(map), 2, "boundary area");
}

std::int64_t latticeLength(const SingularEdge& edge, const ExactMap& map) {
  const LatticeTet& c = map.corners[edge.tet];
  const LatticePoint e = c[edge.corner1] - c[edge.corner0];
  return std::abs(e[0]) + std::abs(e[1]) + std::abs(e[2]);
}

std::uint64_t scaledCells(std::uint64_t volume, int scale, double limit) {
  const double estimate = static_cast<double>(volume) * std::pow(scale, 3);
  if (estimate >= limit) {
    const auto millions = [](double cells) {
      const std::string digits = std::to_string(std::round(cells / 1e6));
      return digits.substr(0, digits.find('.'));
    };
    throw Error(ErrorCode::TooLarge, "The mesh would have about " + millions(estimate) +
                                         " million cells, more than the " + millions(limit) +
                                         " million that can be numbered. Lower the scale.");
  }
  const auto s = static_cast<std::uint64_t>(scale);
  return volume * s * s * s;
}

std::uint64_t componentCount(const TetTopology& topology) {
  DisjointSets sets(topology.tetCount());
  for (HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    const HalfFace mate = topology.mate[halfFace];
    if (mate != kNone && mate > halfFace) sets.unite(tetOf(halfFace), tetOf(mate));
  }
  return sets.count();
}

std::vector<std::int64_t> boundaryGenus(const TetTopology& topology) {
  // Boundary faces as elements named by half-face; vertices and edges are counted at their
  // component's root.
  DisjointSets sets(topology.mate.size());
  std::vector<HalfFace> faceAtVertex(topology.pointCount, kNone);
  for (HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    if (!topology.isBoundary(halfFace)) continue;
    for (int corner = 0; corner < 4; ++corner) {
      if (corner == localOf(halfFace)) continue;
      faceAtVertex[topology.vertex(4 * tetOf(halfFace) + static_cast<Index>(corner))] = halfFace;
      const auto edge = static_cast<CornerMask>(faceMask(localOf(halfFace)) & ~cornerBit(corner));
      sets.unite(halfFace, acrossBoundaryEdge(topology, halfFace, edge));
    }
  }
  std::vector<std::int64_t> faces(topology.mate.size(), 0);
  for (HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    if (topology.isBoundary(halfFace)) ++faces[sets.find(halfFace)];
  }
  std::vector<std::int64_t> vertices(topology.mate.size(), 0);
  for (const HalfFace halfFace : faceAtVertex) {
    if (halfFace != kNone) ++vertices[sets.find(halfFace)];
  }
  std::vector<std::int64_t> genus;
  for (std::size_t root = 0; root < faces.size(); ++root) {
    if (faces[root] == 0) continue;
    const std::int64_t euler = vertices[root] - faces[root] * 3 / 2 + faces[root];
    genus.push_back((2 - euler) / 2);
  }
  std::sort(genus.begin(), genus.end(), std::greater<>());
  return genus;
}

Expectation computeExpectation(const PreparedMap& map, std::uint64_t edges, int scale) {
  const auto s = static_cast<std::uint64_t>(scale / map.exact.scale);
  Expectation expected;
  expected.cells = scaledCells(parametricVolume(map.exact), scale);
  expected.boundaryQuads = boundaryArea(map.topology, map.exact) * s * s;
  // One length is below 2^54, but there may be 2^32 of them.
  std::map<int, Int128> inner;
  std::map<int, Int128> boundary;
  for (const SingularEdge& edge : map.singularities.edges) {
    (edge.boundary ? boundary : inner)[edge.valence] += latticeLength(edge, map.exact);
  }
  for (const auto& [valence, length] : inner) {
    expected.innerSingularEdges[valence] = static_cast<std::uint64_t>(length / map.exact.unit) * s;
  }
  for (const auto& [valence, length] : boundary) {
    expected.boundarySingularEdges[valence] =
        static_cast<std::uint64_t>(length / map.exact.unit) * s;
  }
  std::int64_t used = 0;
  for (Index v = 0; v < map.topology.pointCount; ++v) used += map.topology.isIsolated(v) ? 0 : 1;
  std::int64_t boundaryFaces = 0;
  for (const HalfFace mate : map.topology.mate) boundaryFaces += mate == kNone ? 1 : 0;
  const auto tets = static_cast<std::int64_t>(map.topology.tetCount());
  const std::int64_t faces = (4 * tets + boundaryFaces) / 2;
  expected.eulerCharacteristic = used - static_cast<std::int64_t>(edges) + faces - tets;
  expected.components = componentCount(map.topology);
  expected.boundaryComponents = boundaryGenus(map.topology).size();
  return expected;
}

}  // namespace hexhex
