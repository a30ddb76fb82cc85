// Problems of bending made from two integer-grid maps of one tet mesh: one has the integers, the
// other one the shapes.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <adjacency/tet_topology.hpp>
#include <quantize/bend/bend.hpp>
#include <quantize/bend/edge_turns.hpp>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex::test {

using namespace quantization;

inline double volumeOf(const TetMap& map) {
  double volume = 0;
  for (const TetParameters& u : map.parameters) {
    volume += tripleProduct(minus(u[1], u[0]), minus(u[2], u[0]), minus(u[3], u[0])) / 6;
  }
  return volume;
}

/// The same map with tets that are positive in it.
inline TetMap oriented(TetMap map) {
  if (volumeOf(map) > 0) return map;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    std::swap(map.tets[t][2], map.tets[t][3]);
    std::swap(map.parameters[t][2], map.parameters[t][3]);
  }
  return map;
}

/// The boundary plane that a triangle lies in.
inline BoundaryPlane planeOf(const std::array<Vec3, 3>& triangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = std::round(triangle[0][k]);
    if (std::all_of(triangle.begin(), triangle.end(),
                    [&](const Vec3& u) { return std::abs(u[k] - c) < 1e-9; })) {
      return {static_cast<std::int8_t>(k), static_cast<std::int32_t>(c)};
    }
  }
  throw std::runtime_error("a boundary triangle is in no plane");
}

/// @param target     has the integers
/// @param reference  a map of the same tets in the same charts, up to their origins, whose
///                   parameters are scaled to the volume of the other
inline BendProblem problemFrom(const TetMap& target, const TetMap& reference) {
  if (target.tets != reference.tets) throw std::runtime_error("other tets");
  BendProblem problem;
  problem.points = reference.points;
  problem.tets = reference.tets;
  problem.reference = reference.parameters;
  const double scale = std::cbrt(volumeOf(target) / volumeOf(reference));
  for (TetParameters& tet : problem.reference) {
    for (Vec3& u : tet) u = {scale * u[0], scale * u[1], scale * u[2]};
  }
  problem.transitions.resize(4 * problem.tets.size());
  problem.planes.resize(4 * problem.tets.size());
  Context context;
  Stage stage(context, "test");
  auto topology = adjacency::manifoldTopology(problem.tets, problem.points.size(), stage);
  if (!topology) throw std::runtime_error("no manifold");
  adjacency::addStars(*topology, stage);
  problem.irregularEdges = irregularEdges(adjacency::EdgeFans(*topology), topology->tets,
                                          std::span<const TetParameters>(reference.parameters));
  for (adjacency::HalfFace h = 0; h < problem.transitions.size(); ++h) {
    if (topology->isBoundary(h)) {
      std::array<Vec3, 3> here{};
      for (std::size_t k = 0; k < 3; ++k) {
        here[k] = target.parameters[adjacency::tetOf(h)]
                                   [static_cast<std::size_t>(lattice::kFaceCorners[h % 4][k])];
      }
      problem.planes[h] = planeOf(here);
      continue;
    }
    const igm::FittedTransition fit =
        igm::fitTransition(igm::SharedTriangle(*topology, target.parameters, h));
    if (fit.residual > 1e-9) throw std::runtime_error("no transition fits");
    problem.transitions[h] = fit.transition;
  }
  return problem;
}

inline BentMap bent(BendProblem problem, int threads = 0, const BendOptions& options = {}) {
  Context context(threads);
  Stage stage(context, "bend");
  BentMap map;
  withThreads(threads, [&] { map = bend(std::move(problem), options, stage); });
  return map;
}

inline TetMap mapOf(const BentMap& bentMap) {
  return {bentMap.points, bentMap.tets, bentMap.parameters};
}

}  // namespace hexhex::test
