#include <algorithm>
#include <limits>

#include <quantize/bend/bend_problem.hpp>

#include <lattice/charts_along_trees.hpp>

namespace hexhex::quantization {

namespace {

/// Walls may cut a tet into parts in several blocks. The tet's chart is that of the part that kept
/// its number, which precedes the others.
/// @return per part: from its block's integer chart to the tet's chart
std::vector<lattice::LatticeMotion> waysToOriginal(const MotorcycleComplex& complex,
                                                   const BlockIntegers& integers) {
  const WallMesh& mesh = complex.mesh;
  const auto forEachNeighbour = [&](Index part, const auto& visit) {
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(part, face);
      if (mesh.originalFace[h] != kInside) continue;
      visit(adjacency::tetOf(mesh.mate[h]), [&](const lattice::LatticeMotion& way) {
        return way * integers.across(complex, h).inverse();
      });
    }
  };
  return lattice::chartsAlongTrees<lattice::LatticeMotion>(mesh.tetCount(), forEachNeighbour)
      .motions;
}

std::int32_t toInt32(std::int64_t x) {
  if (x > std::numeric_limits<std::int32_t>::max() / 4 ||
      x < std::numeric_limits<std::int32_t>::min() / 4) {
    throw Error(ErrorCode::TooLarge,
                "The quantized map has more hexahedra along a line than are supported.");
  }
  return static_cast<std::int32_t>(x);
}

lattice::Transition toTransition(const lattice::LatticeMotion& change) {
  const lattice::LatticePoint& t = change.translation;
  return {change.rotation, {toInt32(t[0]), toInt32(t[1]), toInt32(t[2])}};
}

/// Lengths far below one cell are rounded up to one, so a block may be thinner than its integers by
/// orders of magnitude. Ratios up to this one (and its inverse) are left to the solver, as maps
/// then stay closer to the seamless one; it cannot handle a ratio of 10^4.
constexpr double kMostStretch = 4;

/// Per block and axis: the integer length divided by the real one.
/// @param unit  length of a cell on the lattice
std::vector<Vec3> blockRatios(const MotorcycleComplex& complex, const BlockIntegers& integers,
                              double unit) {
  std::vector<Extent> real(complex.blockCount);
  std::vector<Extent> whole(complex.blockCount);
  for (const PatchSide& patch : complex.patches) {
    real[patch.block].add(patch);
    for (const ArcSide& side : patch.border) {
      whole[patch.block].add(integers(patch.block, side.start));
    }
  }
  std::vector<Vec3> ratios(complex.blockCount);
  for (std::size_t block = 0; block < ratios.size(); ++block) {
    const lattice::LatticePoint from = real[block].high - real[block].low;
    const lattice::LatticePoint to = whole[block].high - whole[block].low;
    for (std::size_t k = 0; k < 3; ++k) {
      ratios[block][k] = static_cast<double>(to[k]) * unit / static_cast<double>(from[k]);
    }
  }
  return ratios;
}

/// Factors by which the reference of each tet is stretched along its axes: the mean over its parts,
/// divided by what is left to the solver.
std::vector<Vec3> tetStretches(const MotorcycleComplex& complex,
                               const std::vector<lattice::LatticeMotion>& ways,
                               const std::vector<Vec3>& ratios, std::size_t originals) {
  const WallMesh& mesh = complex.mesh;
  std::vector<Vec3> stretches(originals);
  std::vector<double> volumes(originals);
  for (Index part = 0; part < mesh.tetCount(); ++part) {
    const lattice::LatticeTet& u = mesh.corners[part];
    const double volume = lattice::orientationDeterminant(u[0], u[1], u[2], u[3]).toDouble();
    const Index tet = mesh.original[part];
    volumes[tet] += volume;
    for (int k = 0; k < 3; ++k) {
      const auto axis =
          static_cast<std::size_t>(lattice::axisOf(ways[part].rotation(lattice::direction(k, 1))));
      stretches[tet][axis] += volume * ratios[complex.blockOf[part]][static_cast<std::size_t>(k)];
    }
  }
  for (std::size_t tet = 0; tet < originals; ++tet) {
    for (double& stretch : stretches[tet]) {
      stretch /= volumes[tet];
      stretch /= std::clamp(stretch, 1 / kMostStretch, kMostStretch);
    }
  }
  return stretches;
}

/// The plane across an axis of an integer chart through a given point, in the chart that `way`
/// leads to.
BoundaryPlane toPlane(std::size_t axis, const lattice::LatticePoint& node,
                      const lattice::LatticeMotion& way) {
  const AxisPlane plane = AxisPlane{axis, node[axis]}.beyond(way);
  return {static_cast<std::int8_t>(plane.axis), toInt32(plane.value)};
}

/// Fixes the edges and vertices of aligned features.
void fixFeatures(const MotorcycleComplex& complex, const BlockIntegers& integers,
                 const std::vector<lattice::LatticeMotion>& ways, BendProblem& problem) {
  const WallMesh& mesh = complex.mesh;
  for (const FeatureCorner& at : complex.featureCorners) {
    const Index vertex = mesh.tets[at.tet][at.corner];
    if (vertex >= problem.points.size()) continue;
    const Index tet = mesh.original[at.tet];
    auto& planes =
        problem.fixedCorners[4 * tet + adjacency::localCorner(problem.tets[tet], vertex)];
    const lattice::LatticePoint node = integers(complex.blockOf[at.tet], at.node);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const BoundaryPlane plane = toPlane(axis, node, ways[at.tet]);
      const bool isKnown = std::find(planes.begin(), planes.end(), plane) != planes.end();
      if (axis != at.freeAxis && !isKnown) planes.push_back(plane);
    }
  }
}

}  // namespace

BendProblem bendProblem(const SeamlessMap& map, const MotorcycleComplex& complex,
                        const BlockIntegers& integers, double scale) {
  const TetMapView& view = map.input.view;
  const WallMesh& mesh = complex.mesh;
  BendProblem problem;
  problem.points.assign(view.points.begin(), view.points.end());
  problem.tets.assign(view.tets.begin(), view.tets.end());
  problem.reference.resize(problem.tets.size());
  const std::vector<lattice::LatticeMotion> ways = waysToOriginal(complex, integers);
  const std::vector<Vec3> stretches = tetStretches(
      complex, ways, blockRatios(complex, integers, map.unit / scale), problem.tets.size());
  for (std::size_t t = 0; t < problem.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      const lattice::LatticePoint u = complex.toBlock[t](map.corners[t][i]);
      for (std::size_t k = 0; k < 3; ++k) {
        problem.reference[t][i][k] = static_cast<double>(u[k]) / map.unit * scale * stretches[t][k];
      }
    }
  }
  for (const adjacency::TetEdge& at : map.featureEdges) {
    const Tet& tet = problem.tets[at.tet];
    problem.keptEdges.insert(tetmap::pairOf(tet[at.corner0], tet[at.corner1]));
  }
  problem.transitions.resize(4 * problem.tets.size());
  problem.planes.resize(4 * problem.tets.size());
  for (adjacency::HalfFace h = 0; h < mesh.mate.size(); ++h) {
    if (mesh.originalFace[h] == kInside) continue;
    const Index tet = adjacency::tetOf(h);
    const adjacency::HalfFace original =
        adjacency::halfFaceOf(mesh.original[tet], mesh.originalFace[h]);
    if (mesh.mate[h] == kNone || mesh.isFeature[h]) {
      const PatchSide& patch = complex.patches[complex.patchOf[h]];
      const std::size_t axis = planeOf(mesh, h).beyond(complex.toBlock[tet]).axis;
      problem.planes[original] =
          toPlane(axis, integers(patch.block, patch.border.front().start), ways[tet]);
    }
    if (mesh.mate[h] != kNone) {
      problem.transitions[original] = toTransition(
          ways[adjacency::tetOf(mesh.mate[h])] * integers.across(complex, h) * ways[tet].inverse());
    }
  }
  fixFeatures(complex, integers, ways, problem);
  return problem;
}

}  // namespace hexhex::quantization
