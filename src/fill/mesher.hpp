// The meshers that may be installed, and one run of one of them.
#pragma once

#include <filesystem>
#include <string>

#include <fill/closed_surface.hpp>

#include <hexhex/fill.hpp>

namespace hexhex::fill {

/// What a mesher is to make.
struct Task {
  std::string name;                       ///< of the part, for messages
  const TriangleMesh* surface = nullptr;  ///< of one body; or
  std::filesystem::path step;             ///< a STEP file
  double tetSize = 0;                     ///< 0, for STEP alone: as large as the number says
  double tets = 0;                        ///< about
  double featureAngle = 0;                ///< in degrees
};

struct Meshed {
  TetMesh tets;
  std::string mesher;  ///< with its version, where it tells
};

/// Negative of a tet whose corners are in the other order.
[[nodiscard]] double volumeOf(const TetMesh& mesh, const Tet& tet);

/// @throws Error  as fillSurface(), of meshers that fail or are not there; Cancelled
[[nodiscard]] Meshed runMesher(const Task& task, Mesher mesher, Context& context);

}  // namespace hexhex::fill
