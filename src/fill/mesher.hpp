// The meshers that may be installed, and runs of them until one of them succeeds.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

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
  /// Why the tets of meshers tried before are not taken, and what this one says to the user.
  std::vector<std::string> warnings;
};

/// The signed volume of a tet; negative if its corners are in the opposite order.
[[nodiscard]] double volumeOf(const TetMesh& mesh, const Tet& tet);

/// The tets of the first mesher that is installed, does not fail, and passes a check.
/// @param check  throws an Error for tets that must not be taken, which it may change
/// @throws Error  as fillSurface(), for meshers that fail or are not installed; Cancelled
[[nodiscard]] Meshed runMesher(const Task& task, Mesher mesher,
                               const std::function<void(Meshed&)>& check, Context& context);

}  // namespace hexhex::fill
