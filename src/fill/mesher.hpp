// The meshers that may be installed, and a run of one of them.
#pragma once

#include <filesystem>
#include <string>

#include <fill/closed_surface.hpp>

#include <hexhex/fill.hpp>

namespace hexhex::fill {

/// The task of a mesher.
struct Task {
  std::string name;                       ///< of the part, for messages
  const TriangleMesh* surface = nullptr;  ///< of one body; or
  std::filesystem::path step;             ///< a STEP file
  double tetSize = 0;                     ///< 0, for STEP only: derived from the number
  double tets = 0;                        ///< approximate number
  double featureAngle = 0;                ///< in degrees
};

struct Meshed {
  TetMesh tets;
  std::string mesher;  ///< with its version, if it reports one
};

/// The signed volume of a tet; negative if its corners are in the opposite order.
[[nodiscard]] double volumeOf(const TetMesh& mesh, const Tet& tet);

/// @throws Error  as fillSurface(), for meshers that fail or are not installed; Cancelled
[[nodiscard]] Meshed runMesher(const Task& task, Mesher mesher, Context& context);

}  // namespace hexhex::fill
