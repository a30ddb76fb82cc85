// How many components a surface has, and how many handles: what a mesher must not change.
#pragma once

#include <cstdint>

#include <hexhex/fill.hpp>

namespace hexhex::fill {

struct Topology {
  std::uint64_t components = 0;  ///< connected through vertices
  std::int64_t euler = 0;        ///< used vertices - edges + triangles
  bool operator==(const Topology&) const = default;
};

[[nodiscard]] Topology topologyOf(const TriangleMesh& surface);

}  // namespace hexhex::fill
