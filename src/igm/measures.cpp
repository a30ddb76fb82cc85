// Volume, area, lengths and genus of a map in exact integers (not in the paper).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>

#include <adjacency/edge_fan.hpp>

#include <base/disjoint_sets.hpp>
#include <igm/measures.hpp>

namespace hexhex::igm {

namespace {

int unitBits(const ExactMap& map) { return std::countr_zero(static_cast<std::uint64_t>(map.unit)); }

/// sum / (divisor * 2^shift) as an integer.
std::uint64_t exactQuotient(const lattice::Int192& sum, int shift, unsigned divisor,
                            const char* what) {
  bool exact = true;
  const lattice::UInt128 quotient = sum.shiftedRight(shift, exact);
  if (!exact || quotient % divisor != 0) {
    throw Error(ErrorCode::Internal, std::string("The parametric ") + what +
                                         " of the sanitized map is not an integer. This is a bug; "
                                         "please report it with the map.");
  }
  return static_cast<std::uint64_t>(quotient / divisor);
}

/// A face of a tet in its chart.
struct LatticeTriangle {
  lattice::LatticePoint origin;
  lattice::LatticePoint a;  ///< edges from there
  lattice::LatticePoint b;

  LatticeTriangle(const ExactMap& map, adjacency::HalfFace halfFace) {
    const lattice::LatticeTet& corners = map.corners[adjacency::tetOf(halfFace)];
    const auto corner = [&](std::size_t k) {
      return corners[static_cast<std::size_t>(lattice::kFaceCorners[halfFace % 4][k])];
    };
    origin = corner(0);
    a = corner(1) - origin;
    b = corner(2) - origin;
  }
  /// A component of the normal, which points into the tet.
  [[nodiscard]] lattice::Int128 normal(std::size_t axis) const noexcept {
    return lattice::crossComponent(a, b, axis);
  }
};

/// The boundary half-face across an edge of a boundary half-face, on the far side of the tets
/// between them.
adjacency::HalfFace acrossBoundaryEdge(const adjacency::TetTopology& topology,
                                       adjacency::HalfFace halfFace, lattice::CornerMask edge) {
  adjacency::EdgeTurn turn(topology, adjacency::tetOf(halfFace), edge,
                           adjacency::otherFaceAtEdge(edge, adjacency::localOf(halfFace)));
  turn.goToBoundary();
  return turn.out();
}

}  // namespace

/// The volume of a tet is the sum of the volumes between its faces and the origin. At inner faces
/// these cancel, except for the effect of the transition: if it is a rotation followed by a
/// translation by t, the scalar product of t with the triangle's normal remains.
lattice::Int192 sixfoldVolume(const RegularVertices& regular, const ExactMap& map, Stage& stage) {
  const Transitions& transitions = map.transitions;
  std::vector<lattice::Int192> sums(regular.boundaryFaces.size());
  parallelFor(stage, sums.size(), 1, [&](std::size_t block) {
    lattice::Int192 sum;
    for (const RegularVertices::BoundaryFace& face : regular.boundaryFaces[block]) {
      const LatticeTriangle triangle(map, face.halfFace);
      // The normal is parallel to an axis.
      sum.addProduct(triangle.normal(face.axis), -triangle.origin[face.axis]);
    }
    for (const adjacency::HalfFace halfFace : regular.unequalFaces[block]) {
      const Index back = Transitions::inverse(transitions.ofFace[halfFace]);
      const lattice::GridPoint& translation = transitions.table[back].translation;
      const LatticeTriangle triangle(map, halfFace);
      for (std::size_t k = 0; k < 3; ++k) {
        sum.addProduct(triangle.normal(k), -translation[k] * map.unit);
      }
    }
    sums[block] = sum;
  });
  lattice::Int192 volume;
  for (const lattice::Int192& sum : sums) volume += sum;
  return volume;
}

std::uint64_t parametricVolume(const ExactMap& map) {
  return exactQuotient(map.sixfoldVolume, 3 * unitBits(map), 6, "volume");
}

std::uint64_t boundaryArea(const adjacency::TetTopology& topology, const ExactMap& map) {
  lattice::Int192 sum;
  for (adjacency::HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    if (!topology.isBoundary(halfFace)) continue;
    const LatticeTriangle triangle(map, halfFace);
    // It lies in a grid plane: some component of its normal is not zero.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const lattice::Int128 component = triangle.normal(axis);
      sum += lattice::Int192(component < 0 ? -component : component);
    }
  }
  return exactQuotient(sum, 2 * unitBits(map), 2, "boundary area");
}

std::int64_t latticeLength(const SingularEdge& edge, const ExactMap& map) {
  const lattice::LatticeTet& c = map.corners[edge.tet];
  const lattice::LatticePoint e = c[edge.corner1] - c[edge.corner0];
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

std::uint64_t componentCount(const adjacency::TetTopology& topology) {
  DisjointSets sets(topology.tetCount());
  for (adjacency::HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    const adjacency::HalfFace mate = topology.mate[halfFace];
    if (mate != kNone && mate > halfFace)
      sets.unite(adjacency::tetOf(halfFace), adjacency::tetOf(mate));
  }
  return sets.count();
}

std::vector<std::int64_t> boundaryGenus(const adjacency::TetTopology& topology) {
  // The elements are boundary faces, named by half-face; vertices and edges are counted at the root
  // of their component.
  DisjointSets sets(topology.mate.size());
  std::vector<adjacency::HalfFace> faceAtVertex(topology.pointCount, kNone);
  for (adjacency::HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    if (!topology.isBoundary(halfFace)) continue;
    for (int corner = 0; corner < 4; ++corner) {
      if (corner == adjacency::localOf(halfFace)) continue;
      faceAtVertex[topology.vertex(4 * adjacency::tetOf(halfFace) + static_cast<Index>(corner))] =
          halfFace;
      const auto edge = static_cast<lattice::CornerMask>(
          lattice::faceMask(adjacency::localOf(halfFace)) & ~lattice::cornerBit(corner));
      sets.unite(halfFace, acrossBoundaryEdge(topology, halfFace, edge));
    }
  }
  std::vector<std::int64_t> faces(topology.mate.size(), 0);
  for (adjacency::HalfFace halfFace = 0; halfFace < topology.mate.size(); ++halfFace) {
    if (topology.isBoundary(halfFace)) ++faces[sets.find(halfFace)];
  }
  std::vector<std::int64_t> vertices(topology.mate.size(), 0);
  for (const adjacency::HalfFace halfFace : faceAtVertex) {
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
  // A single length is below 2^54, but there may be 2^32 of them.
  std::map<int, lattice::Int128> inner;
  std::map<int, lattice::Int128> boundary;
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
  for (const adjacency::HalfFace mate : map.topology.mate) boundaryFaces += mate == kNone ? 1 : 0;
  const auto tets = static_cast<std::int64_t>(map.topology.tetCount());
  const std::int64_t faces = (4 * tets + boundaryFaces) / 2;
  expected.eulerCharacteristic = used - static_cast<std::int64_t>(edges) + faces - tets;
  expected.components = componentCount(map.topology);
  expected.boundaryComponents = boundaryGenus(map.topology).size();
  return expected;
}

}  // namespace hexhex::igm
