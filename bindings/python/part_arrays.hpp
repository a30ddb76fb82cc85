// Parts of a mesh as Python has them.
#pragma once

#include <hexhex/parts.hpp>

#include "border.hpp"

namespace hexhex::python {

[[nodiscard]] PartOptions partOptions(std::uint32_t parts, std::uint32_t ghosts,
                                      const std::string& partition, bool verify);
/// The fields of the class MeshPart, in their order.
[[nodiscard]] nb::tuple partTuple(MeshPart&& part);

}  // namespace hexhex::python
