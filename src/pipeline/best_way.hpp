// Several ways to a mesh of one part, beside each other: which errors belong to a way, and which
// mesh is kept.
#pragma once

#include <cstdint>
#include <functional>

#include <hexhex/error.hpp>
#include <hexhex/mesh.hpp>

namespace hexhex::pipeline {

/// One way has no mesh; another one may have.
class Refusal : public Error {
 public:
  /// @param hasMap  whether the way had made a map, so that another map of its may have a mesh
  explicit Refusal(const Error& error, bool hasMap = false) : Error(error), hasMap_(hasMap) {}

  [[nodiscard]] bool hasMap() const noexcept { return hasMap_; }

 private:
  bool hasMap_;
};

/// Whether an error belongs to the way that met it. Others are about the part, the options or this
/// machine, wish to end, or are bugs: no other way may hide them.
/// @param hasMap  whether the way had made a map: then tets and their topology are those of the map
[[nodiscard]] bool isOfTheWay(ErrorCode code, bool hasMap) noexcept;

/// Makes a mesh of one map after the other, until there is one, or there are no more maps.
/// @param meshOfMap  makes a mesh of the map of that number
/// @param mostMaps  1 or more
/// @throws Refusal  the first one, if all are refused
[[nodiscard]] MeshedPart firstMesh(const std::function<MeshedPart(std::uint64_t)>& meshOfMap,
                                   std::uint64_t mostMaps);

/// Makes a mesh by one way; throws Refusal where only this one has none.
using Way = std::function<MeshedPart(ShapeMethod, Context&)>;

/// Goes both ways, and keeps the better mesh. A polycube that nothing could be better than ends the
/// search. The result is the same whether both run at once or one after the other.
/// @param atOnce  if there is more than one thread
/// @throws Error NotMeshable with the reasons of both
[[nodiscard]] MeshedPart bestOfBothWays(const Way& way, bool atOnce, Context& context);

}  // namespace hexhex::pipeline
