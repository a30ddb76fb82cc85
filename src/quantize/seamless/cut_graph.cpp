#include <algorithm>
#include <utility>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <quantize/seamless/cut_graph.hpp>

#include <base/disjoint_sets.hpp>
#include <base/vector3.hpp>
#include <igm/transition_fit.hpp>
#include <lattice/charts_along_trees.hpp>

namespace hexhex::quantization {

namespace {

/// From a tet's chart to the common chart.
using Motion = lattice::GridMotion<double>;

/// The centroid of a triangle in the charts of both its tets.
std::array<Vec3, 2> middlesOf(const igm::SharedTriangle& triangle) {
  std::array<Vec3, 2> middles{};
  for (std::size_t k = 0; k < 3; ++k) {
    middles[0] = plus(middles[0], triangle.here[k]);
    middles[1] = plus(middles[1], triangle.there[k]);
  }
  for (Vec3& middle : middles) {
    for (double& x : middle) x /= 3;
  }
  return middles;
}

/// The rotation after which two edges of a tet are lexicographically largest; it does not depend on
/// the tet's chart.
lattice::Rotation canonicalRotation(const TetParameters& u) {
  lattice::Rotation best;
  std::array<Vec3, 2> last{};
  for (int r = 0; r < lattice::Rotation::kCount; ++r) {
    const lattice::Rotation rotation(r);
    std::array<Vec3, 2> image = {rotation(minus(u[1], u[0])), rotation(minus(u[2], u[0]))};
    for (Vec3& v : image) {
      for (double& x : v) x = static_cast<double>(static_cast<float>(x));  // removes noise
    }
    if (r == 0 || image > last) {
      best = rotation;
      last = image;
    }
  }
  return best;
}

/// Moves all tets of each component into the chart of its first one, along a spanning tree.
/// @return the motion of each tet; marks triangles of the tree in `isTree`
std::vector<Motion> moveAlongTree(const adjacency::TetTopology& topology,
                                  std::span<const TetParameters> parameters,
                                  std::span<const lattice::Rotation> rotations,
                                  std::vector<bool>& isTree) {
  const auto begin = [&](Index root) { return Motion{canonicalRotation(parameters[root])}; };
  const auto forEachNeighbour = [&](Index tet, const auto& visit) {
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace out = adjacency::halfFaceOf(tet, face);
      const adjacency::HalfFace mate = topology.mate[out];
      if (mate == kNone) continue;
      visit(adjacency::tetOf(mate), [&](const Motion& here) {
        isTree[out] = isTree[mate] = true;
        const auto middles = middlesOf({topology, parameters, out});
        return Motion::taking(middles[1], here(middles[0]),
                              here.rotation * rotations[out].inverse());
      });
    }
  };
  return lattice::chartsAlongTrees<Motion>(topology.tetCount(), begin, forEachNeighbour).motions;
}

/// Removes loose ends of the cut: triangles that are the only cut ones at an edge around which
/// charts agree.
void mendCut(const adjacency::TetTopology& topology, const adjacency::EdgeFans& edges,
             CutGraph& graph) {
  std::vector<Index> cutFaces(edges.size());  // counts half-faces, i.e. two per triangle
  std::vector<Index> ends;
  const auto lookAt = [&](Index edge) {
    if (cutFaces[edge] == 2 && !edges.isBoundary(edge)) ends.push_back(edge);
  };
  for (Index edge = 0; edge < edges.size(); ++edge) {
    for (const adjacency::EdgeCorner& at : edges(edge)) {
      forEachFaceAt(at, [&](adjacency::HalfFace h) { cutFaces[edge] += graph.isCut[h] ? 1 : 0; });
    }
    lookAt(edge);
  }
  const auto mend = [&](adjacency::HalfFace halfFace) {
    graph.isCut[halfFace] = graph.isCut[topology.mate[halfFace]] = false;
    for (int i = 0; i < 4; ++i) {
      if (i == adjacency::localOf(halfFace)) continue;
      const auto ends4 = static_cast<lattice::CornerMask>(
          lattice::faceMask(adjacency::localOf(halfFace)) ^ lattice::cornerBit(i));
      const Index edge = edges.edgeOf(adjacency::tetOf(halfFace), ends4);
      cutFaces[edge] -= 2;
      lookAt(edge);
    }
  };
  while (!ends.empty()) {
    const Index edge = ends.back();
    ends.pop_back();
    if (cutFaces[edge] != 2) continue;
    adjacency::HalfFace last = kNone;
    for (const adjacency::EdgeCorner& at : edges(edge)) {
      forEachFaceAt(at, [&](adjacency::HalfFace h) { last = graph.isCut[h] ? h : last; });
    }
    if (graph.rotations[last].isIdentity()) mend(last);
  }
}

/// Translates charts to minimize the gaps across uncut triangles (least squares): along the tree
/// alone, the noise of successive triangles accumulates.
void levelCharts(const adjacency::TetTopology& topology, CutGraph& graph) {
  const auto n = static_cast<Eigen::Index>(topology.tetCount());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d differences = Eigen::MatrixX3d::Zero(n, 3);
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    const adjacency::HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h || graph.isCut[h]) continue;
    const Index t = adjacency::tetOf(h);
    const Index other = adjacency::tetOf(mate);
    const auto middles = middlesOf({topology, graph.parameters, h});
    const Vec3 apart = minus(middles[1], middles[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      differences(t, static_cast<Eigen::Index>(k)) += apart[k];
      differences(other, static_cast<Eigen::Index>(k)) -= apart[k];
    }
    for (const auto& [a, b] : {std::pair(t, other), std::pair(other, t)}) {
      entries.emplace_back(a, a, 1);
      entries.emplace_back(a, b, -1);
    }
  }
  if (differences.isZero(0)) return;
  // Regularization, as translations of all charts together cost nothing.
  for (Eigen::Index t = 0; t < n; ++t) entries.emplace_back(t, t, 1e-9);
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(1e-6);
  solver.compute(matrix);
  const Eigen::MatrixX3d moves = solver.solve(differences);
  for (Eigen::Index t = 0; t < n; ++t) {
    for (Vec3& u : graph.parameters[static_cast<std::size_t>(t)]) {
      u = plus(u, {moves(t, 0), moves(t, 1), moves(t, 2)});
    }
  }
}

/// Numbers sectors: corners at a vertex that uncut triangles connect.
void numberSectors(const adjacency::TetTopology& topology, CutGraph& graph) {
  DisjointSets sets(4 * topology.tetCount());
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    const adjacency::HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h || graph.isCut[h]) continue;
    const adjacency::SharedFace face(topology, h, mate);
    for (std::size_t k = 0; k < 3; ++k) {
      sets.unite(adjacency::halfFaceOf(adjacency::tetOf(h), static_cast<int>(face.here(k))),
                 adjacency::halfFaceOf(adjacency::tetOf(mate), static_cast<int>(face.there(k))));
    }
  }
  graph.sectors.resize(4 * topology.tetCount());
  for (adjacency::CornerIndex corner = 0; corner < graph.sectors.size(); ++corner) {
    // The smallest corner of a set has already been numbered.
    const adjacency::CornerIndex first = sets.find(corner);
    graph.sectors[corner] =
        first == corner ? static_cast<Index>(graph.sectorCount++) : graph.sectors[first];
  }
}

}  // namespace

std::vector<lattice::Rotation> fitRotations(const adjacency::TetTopology& topology,
                                            std::span<const TetParameters> parameters) {
  std::vector<lattice::Rotation> rotations(topology.mate.size());
  for (adjacency::HalfFace h = 0; h < rotations.size(); ++h) {
    const adjacency::HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h) continue;
    rotations[h] = igm::bestRotation(igm::SharedTriangle(topology, parameters, h));
    rotations[mate] = rotations[h].inverse();
  }
  return rotations;
}

CutGraph cutOpen(const adjacency::TetTopology& topology, const adjacency::EdgeFans& edges,
                 std::span<const TetParameters> parameters,
                 std::span<const lattice::Rotation> rotations) {
  CutGraph graph;
  std::vector<bool> isTree(topology.mate.size());
  // Moves each tet to the origin: far from it, sums would lose digits that differences still have.
  graph.parameters.assign(parameters.begin(), parameters.end());
  for (TetParameters& tet : graph.parameters) {
    const Vec3 origin = tet[0];
    for (Vec3& u : tet) u = minus(u, origin);
  }
  const std::vector<Motion> motions = moveAlongTree(topology, graph.parameters, rotations, isTree);
  for (std::size_t t = 0; t < graph.parameters.size(); ++t) {
    for (Vec3& u : graph.parameters[t]) u = motions[t](u);
  }
  graph.rotations.resize(topology.mate.size());
  graph.isCut.resize(topology.mate.size());
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    const adjacency::HalfFace mate = topology.mate[h];
    if (mate == kNone) continue;
    graph.rotations[h] = motions[adjacency::tetOf(mate)].rotation * rotations[h] *
                         motions[adjacency::tetOf(h)].rotation.inverse();
    graph.isCut[h] = !isTree[h];
  }
  mendCut(topology, edges, graph);
  levelCharts(topology, graph);
  numberSectors(topology, graph);
  return graph;
}

adjacency::HalfFace nextCutAround(const adjacency::TetTopology& topology, const CutGraph& graph,
                                  lattice::CornerMask edge, adjacency::HalfFace halfFace) {
  adjacency::EdgeTurn turn(topology, adjacency::tetOf(halfFace), edge,
                           adjacency::otherFaceAtEdge(edge, adjacency::localOf(halfFace)));
  while (turn.next() != kNone && !graph.isCut[turn.out()]) turn.step();
  return turn.next() == kNone ? kNone : turn.out();
}

}  // namespace hexhex::quantization
