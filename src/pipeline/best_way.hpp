// Runs several ways to a mesh of one part: decides which errors concern one way only, and which
// mesh to keep.
#pragma once

#include <cstdint>
#include <functional>

#include <hexhex/error.hpp>
#include <hexhex/mesh.hpp>

namespace hexhex::pipeline {

/// One way leads to no mesh; another may.
class Refusal : public Error {
 public:
  /// @param hasMap  whether the way had made a map, so that another map of its may have a mesh
  explicit Refusal(const Error& error, bool hasMap = false) : Error(error), hasMap_(hasMap) {}

  [[nodiscard]] bool hasMap() const noexcept { return hasMap_; }

 private:
  bool hasMap_;
};

/// Whether an error concerns only the way that met it. The others (a bad part, bad options, lack of
/// resources, cancellation, bugs) must not be hidden by the success of another way.
/// @param hasMap  whether the way had made a map: errors about tets then refer to that map
[[nodiscard]] bool isOfTheWay(ErrorCode code, bool hasMap) noexcept;

/// Makes a mesh of one map after the other, until there is one, or there are no more maps.
/// @param meshOfMap  makes a mesh of the map of that number
/// @param mostMaps  1 or more
/// @throws Refusal  the first one, if all are refused
[[nodiscard]] MeshedPart firstMesh(const std::function<MeshedPart(std::uint64_t)>& meshOfMap,
                                   std::uint64_t mostMaps);

/// Makes a mesh by one way; throws Refusal if that way has none.
using Way = std::function<MeshedPart(ShapeMethod, Context&)>;

/// Tries both ways and keeps the better mesh. A good enough polycube ends the search. The result is
/// the same whether they run at once or one after the other.
/// @param atOnce  run both at once if there is more than one thread
/// @throws Error NotMeshable with the reasons of both
[[nodiscard]] MeshedPart bestOfBothWays(const Way& way, bool atOnce, Context& context);

}  // namespace hexhex::pipeline
