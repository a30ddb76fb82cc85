// Runs several ways to a mesh of one part: decides which errors concern one way only, and which
// mesh to keep.
#pragma once

#include <functional>

#include <hexhex/error.hpp>
#include <hexhex/mesh.hpp>

namespace hexhex::pipeline {

/// One way leads to no mesh; another may.
class Refusal : public Error {
 public:
  explicit Refusal(const Error& error) : Error(error) {}
};

/// Whether an error concerns only the way that met it. The others (a bad part, bad options, lack of
/// resources, cancellation, bugs) must not be hidden by the success of another way.
/// @param hasMap  whether the way had made a map: errors about tets then refer to that map
[[nodiscard]] bool isOfTheWay(ErrorCode code, bool hasMap) noexcept;

/// Makes a mesh by one way; throws Refusal if that way has none.
using Way = std::function<MeshedPart(ShapeMethod, Context&)>;

/// Tries both ways and keeps the better mesh. A good enough polycube ends the search. The result is
/// the same whether they run at once or one after the other.
/// @param atOnce  run both at once if there is more than one thread
/// @throws Error NotMeshable with the reasons of both
[[nodiscard]] MeshedPart bestOfBothWays(const Way& way, bool atOnce, Context& context);

}  // namespace hexhex::pipeline
