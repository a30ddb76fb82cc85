// Bends the tets of a polycube onto planes, without flips.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <quantize/polycube/problem.hpp>

#include <base/stage.hpp>

namespace hexhex::quantization {

/// Coordinates along the object's longest side are at least so large: planes that are nearer than 1
/// to each other count as one.
inline constexpr double kPolycubeUnits = 0x1p20;

/// Where tets were bent to, and which elements of the problem are not good there.
struct BentTets {
  PolycubeProblem problem;
  std::vector<std::size_t> flipped;
  bool isWound = false;  ///< none is flipped, but these are tets that overlap around edges
  int steps = 0;         ///< of the solver
};

/// Objects need one or the other: planes that stay, or move with the tets. Whether a map is good is
/// decided exactly, after its coordinates have been rounded, and without the solver.
/// @param start  with tets only, near to where the rotations turn them
/// @param mostSteps  of the solver, until nothing is flipped, more or less
[[nodiscard]] BentTets bendTets(const LabelledMesh& mesh, const PolycubeProblem& start,
                                std::span<const PolycubeEdge> edges, bool fixPlanes, int mostSteps,
                                Stage& stage);

/// Of the corners of tets.
[[nodiscard]] std::vector<TetParameters> parametersOf(const LabelledMesh& mesh,
                                                      const PolycubeProblem& problem);

}  // namespace hexhex::quantization
