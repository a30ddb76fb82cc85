// Maps the tets of a polycube so that labelled triangles lie in their planes, without flips
// (Garanzha et al. 2021, src/untangle).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <quantize/polycube/problem.hpp>

#include <base/stage.hpp>

namespace hexhex::quantization {

/// Minimum extent of the scaled object along its longest side. Planes less than 1 apart count as
/// one.
inline constexpr double kPolycubeUnits = 0x1p20;

/// The outcome of bendTets().
struct BentTets {
  PolycubeProblem problem;
  std::vector<std::size_t> flipped;
  bool isWound = false;  ///< whether `flipped` lists positive tets that overlap around edges
  int steps = 0;         ///< solver steps taken
};

/// Untangles the tets, either with planes fixed or with planes that move along; some objects need
/// the former, some the latter. The result is rounded and then validated exactly, without the
/// solver.
/// @param start  the problem with tets only, solved for the planes
/// @param mostSteps  approximate limit of solver steps until nothing is flipped
[[nodiscard]] BentTets bendTets(const LabelledMesh& mesh, const PolycubeProblem& start,
                                std::span<const PolycubeEdge> edges, bool fixPlanes, int mostSteps,
                                Stage& stage);

/// The positions of the corners of each tet in the map.
[[nodiscard]] std::vector<TetParameters> parametersOf(const LabelledMesh& mesh,
                                                      const PolycubeProblem& problem);

}  // namespace hexhex::quantization
