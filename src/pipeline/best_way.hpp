// Meshes one part in two ways, by a polycube and along frames: decides which errors concern one way
// only, and which mesh to keep.
#pragma once

#include <cstdint>
#include <functional>

#include <hexhex/error.hpp>
#include <hexhex/mesh.hpp>

namespace hexhex::pipeline {

/// One way found no mesh; another one may.
class Refusal : public Error {
 public:
  /// @param hasMap  whether the way had made a map, in which case another of its maps may have a
  ///         mesh
  explicit Refusal(const Error& error, bool hasMap = false) : Error(error), hasMap_(hasMap) {}

  [[nodiscard]] bool hasMap() const noexcept { return hasMap_; }

 private:
  bool hasMap_;
};

/// Whether an error only concerns the way that threw it. Any other error (a bad part, bad options,
/// lack of resources, cancellation, bugs) must not be hidden by the success of another way.
/// @param hasMap  whether the way had made a map: errors about tets then refer to that map
[[nodiscard]] bool isOfTheWay(ErrorCode code, bool hasMap) noexcept;

/// Tries one map after the other until one leads to a mesh.
/// @param meshOfMap  meshes the map with the given number
/// @param mostMaps  1 or more
/// @throws Refusal  the first one, if no map leads to a mesh
[[nodiscard]] MeshedPart firstMesh(const std::function<MeshedPart(std::uint64_t)>& meshOfMap,
                                   std::uint64_t mostMaps);

/// Meshes the part in one way; throws Refusal if that is not possible.
using Way = std::function<MeshedPart(ShapeMethod, Context&)>;

/// Tries both ways and keeps the better mesh. A good enough polycube mesh ends the search. The
/// result does not depend on whether the ways run at once or in turn.
/// @param atOnce  run both at once if there is more than one thread
/// @throws Error NotMeshable with the reasons of both
[[nodiscard]] MeshedPart bestOfBothWays(const Way& way, bool atOnce, Context& context);

}  // namespace hexhex::pipeline
