#include <algorithm>
#include <limits>

#include <quantize/bend_problem.hpp>

namespace hexhex::quantization {

namespace {

/// Walls may cut a tet into parts in several blocks. Its chart is that of the block of one of them;
/// this is the way from the other ones' integer charts into it.
std::vector<ChartChange> waysToOriginal(const MotorcycleComplex& complex,
                                        const BlockIntegers& integers, std::size_t originals) {
  const WallMesh& mesh = complex.mesh;
  std::vector<ChartChange> ways(mesh.tetCount());
  std::vector<bool> isReached(mesh.tetCount());
  std::vector<Index> queue;
  for (Index root = 0; root < originals; ++root) {
    isReached[root] = true;
    queue.assign(1, root);
    for (std::size_t next = 0; next < queue.size(); ++next) {
      for (int face = 0; face < 4; ++face) {
        const adjacency::HalfFace h = adjacency::halfFaceOf(queue[next], face);
        if (mesh.originalFace[h] != kInside) continue;
        const Index there = adjacency::tetOf(mesh.mate[h]);
        if (isReached[there]) continue;
        isReached[there] = true;
        ways[there] = ways[queue[next]] * integers.across(complex, h).inverse();
        queue.push_back(there);
      }
    }
  }
  return ways;
}

std::int32_t toInt32(std::int64_t x) {
  if (x > std::numeric_limits<std::int32_t>::max() / 4 ||
      x < std::numeric_limits<std::int32_t>::min() / 4) {
    throw Error(ErrorCode::TooLarge,
                "The quantized map has more hexahedra along a line than are supported.");
  }
  return static_cast<std::int32_t>(x);
}

lattice::Transition toTransition(const ChartChange& change) {
  const lattice::LatticePoint& t = change.translation;
  return {change.rotation, {toInt32(t[0]), toInt32(t[1]), toInt32(t[2])}};
}

/// The triangles, edges and vertices of features that are aligned.
void fixFeatures(const MotorcycleComplex& complex, const BlockIntegers& integers,
                 const std::vector<ChartChange>& ways, BendProblem& problem) {
  const WallMesh& mesh = complex.mesh;
  const auto toPlane = [&](Index tet, std::size_t axis, const lattice::LatticePoint& node) {
    const AxisPlane plane = AxisPlane{axis, node[axis]}.beyond(ways[tet]);
    return BoundaryPlane{static_cast<std::int8_t>(plane.axis), toInt32(plane.value)};
  };
  for (adjacency::HalfFace h = 0; h < mesh.mate.size(); ++h) {
    if (!mesh.isFeature[h] || mesh.originalFace[h] == kInside) continue;
    const Index tet = adjacency::tetOf(h);
    const PatchSide& patch = complex.patches[complex.patchOf[h]];
    const std::size_t axis = planeOf(mesh, h).beyond(complex.toBlock[tet]).axis;
    problem.planes[adjacency::halfFaceOf(mesh.original[tet], mesh.originalFace[h])] =
        toPlane(tet, axis, integers(patch.block, patch.border.front().start));
  }
  for (const FeatureCorner& at : complex.featureCorners) {
    const Index vertex = mesh.tets[at.tet][at.corner];
    if (vertex >= problem.points.size()) continue;
    const Index tet = mesh.original[at.tet];
    auto& planes =
        problem.fixedCorners[4 * tet + adjacency::localCorner(problem.tets[tet], vertex)];
    const lattice::LatticePoint node = integers(complex.blockOf[at.tet], at.node);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const BoundaryPlane plane = toPlane(at.tet, axis, node);
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
  for (std::size_t t = 0; t < problem.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      const lattice::LatticePoint u = complex.toBlock[t](map.corners[t][i]);
      for (std::size_t k = 0; k < 3; ++k) {
        problem.reference[t][i][k] = static_cast<double>(u[k]) / map.unit * scale;
      }
    }
  }
  for (const adjacency::EdgeCorner& at : map.featureEdges) {
    const Tet& tet = problem.tets[at.tet];
    problem.keptEdges.insert(pairOf(tet[at.corner0], tet[at.corner1]));
  }
  problem.transitions.resize(4 * problem.tets.size());
  problem.planes.resize(4 * problem.tets.size());
  const std::vector<ChartChange> ways = waysToOriginal(complex, integers, problem.tets.size());
  for (adjacency::HalfFace h = 0; h < mesh.mate.size(); ++h) {
    if (mesh.originalFace[h] == kInside) continue;
    const Index tet = adjacency::tetOf(h);
    const adjacency::HalfFace original =
        adjacency::halfFaceOf(mesh.original[tet], mesh.originalFace[h]);
    if (mesh.mate[h] == kNone) {
      const PatchSide& patch = complex.patches[complex.patchOf[h]];
      const std::size_t axis = planeOf(mesh, h).beyond(complex.toBlock[tet]).axis;
      const lattice::LatticePoint node = integers(patch.block, patch.border.front().start);
      const AxisPlane plane = AxisPlane{axis, node[axis]}.beyond(ways[tet]);
      problem.planes[original] = {static_cast<std::int8_t>(plane.axis), toInt32(plane.value)};
    } else {
      problem.transitions[original] = toTransition(
          ways[adjacency::tetOf(mesh.mate[h])] * integers.across(complex, h) * ways[tet].inverse());
    }
  }
  fixFeatures(complex, integers, ways, problem);
  return problem;
}

}  // namespace hexhex::quantization
