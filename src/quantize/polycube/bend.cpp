#include <cmath>

#include <quantize/bend/edge_turns.hpp>
#include <quantize/polycube/bend.hpp>
#include <untangle/untangle.hpp>

#include <lattice/tet_geometry.hpp>

namespace hexhex::quantization {

namespace {

/// Final coordinates are rounded to multiples of 1 / kRounding, far below the distance of planes,
/// so that products of them are exact.
constexpr double kRounding = 0x1p20;
/// Weight of boundary triangles and edges relative to tets of their size.
constexpr double kBoundaryWeight = 3;
/// Weights of the rotation term of tets: while untangling, high enough to keep parts from
/// collapsing, and then lower.
constexpr double kPull = 0.5;
constexpr double kLastPull = 0.1;

/// Rounds coordinates, which makes all later decisions exact.
/// @return tets without positive volume
std::vector<std::size_t> roundAll(const LabelledMesh& mesh, PolycubeProblem& problem) {
  for (double& x : problem.solved().x) x = std::nearbyint(x * kRounding) / kRounding;
  std::vector<std::size_t> flipped;
  for (Index t = 0; t < mesh.topology.tetCount(); ++t) {
    lattice::LatticeTet lattice;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        lattice[i][k] =
            static_cast<std::int64_t>(problem.at(mesh.topology.tets[t][i], k) * kRounding);
      }
    }
    if (lattice::orientation(lattice[0], lattice[1], lattice[2], lattice[3]) <= 0)
      flipped.push_back(t);
  }
  return flipped;
}

/// Tets that lie on the outer side of the plane of a labelled triangle, which thus faces opposite
/// to its label.
std::vector<std::size_t> tetsOnOtherSides(const LabelledMesh& mesh,
                                          const PolycubeProblem& problem) {
  std::vector<std::size_t> tets;
  for (adjacency::HalfFace h = 0; h < mesh.flags.size(); ++h) {
    if (!mesh.isLabelled(h)) continue;
    const auto axis = static_cast<std::size_t>(lattice::axisOf(mesh.label(h)));
    const Tet& tet = mesh.topology.tets[adjacency::tetOf(h)];
    const auto corner = static_cast<std::size_t>(lattice::kFaceCorners[h % 4][0]);
    const double depth = problem.at(tet[corner], axis) - problem.at(tet[h % 4], axis);
    if (!(lattice::signOf(mesh.label(h)) * depth > 0)) tets.push_back(adjacency::tetOf(h));
  }
  return tets;
}

/// Rounds a map and validates it exactly, independently of the solver.
void finish(const LabelledMesh& mesh, std::span<const PolycubeEdge> edges, BentTets& bent,
            Stage& stage) {
  bent.flipped = roundAll(mesh, bent.problem);
  if (bent.flipped.empty()) bent.flipped = tetsOnOtherSides(mesh, bent.problem);
  if (!bent.flipped.empty()) return;
  IrregularEdges expected;
  for (const PolycubeEdge& edge : edges) expected[edge.vertices] = edge.quarters;
  const std::vector<Index> wound =
      tetsAtOtherTurns(mesh.topology, expected, parametersOf(mesh, bent.problem), stage);
  bent.flipped.assign(wound.begin(), wound.end());
  bent.isWound = !wound.empty();
}

}  // namespace

BentTets bendTets(const LabelledMesh& mesh, const PolycubeProblem& start,
                  std::span<const PolycubeEdge> edges, bool fixPlanes, int mostSteps,
                  Stage& stage) {
  BentTets bent{.problem = start, .flipped = {}, .isWound = false, .steps = 0};
  bent.problem.addBoundary(edges, kBoundaryWeight);
  if (fixPlanes) bent.problem.fixPlanes();
  untangle::Problem& problem = bent.problem.solved();
  untangle::Solver solver(problem, stage);
  problem.pull = kPull;
  untangle::Result result =
      solver.run({.epsilon = 1, .polishing = 0, .isPatient = true, .mostSteps = mostSteps});
  bent.steps = result.steps;
  bent.flipped = std::move(result.flipped);
  if (!bent.flipped.empty()) return bent;
  problem.pull = kLastPull;
  bent.steps += solver.run({.epsilon = 1e-3}).steps;
  finish(mesh, edges, bent, stage);
  return bent;
}

std::vector<TetParameters> parametersOf(const LabelledMesh& mesh, const PolycubeProblem& problem) {
  std::vector<TetParameters> parameters(mesh.topology.tetCount());
  for (std::size_t t = 0; t < parameters.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        parameters[t][i][k] = problem.at(mesh.topology.tets[t][i], k);
      }
    }
  }
  return parameters;
}

}  // namespace hexhex::quantization
