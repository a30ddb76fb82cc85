// Global propellers: each hex edge traced once, from vertex to vertex (Section 5.4).
#pragma once

#include <cstdint>

#include <hexhex/types.hpp>

#include <propeller/local_connectivity.hpp>

namespace hexhex::propeller {

/// Where a global propeller (hex vertex, local propeller) leads: its opposite, and the connection
/// offset, by which blade i corresponds to blade (offset - i) of the opposite, modulo their number.
struct Opposite {
  Index vertex;
  std::uint16_t propeller;
  std::uint16_t offset;
};

/// Global propellers of a vertex stand in a row, those of a generator's vertices too.
struct GlobalConnectivity {
  Array<std::uint64_t> begin;      ///< per generator: the first propeller of its first vertex
  Array<std::uint64_t> opposites;  ///< packed: vertex, propeller << 32, offset << 48

  [[nodiscard]] static constexpr std::uint64_t pack(const Opposite& o) noexcept {
    return o.vertex | (std::uint64_t{o.propeller} << 32) | (std::uint64_t{o.offset} << 48);
  }
  [[nodiscard]] static constexpr Opposite unpack(std::uint64_t packed) noexcept {
    return {static_cast<Index>(packed), static_cast<std::uint16_t>(packed >> 32),
            static_cast<std::uint16_t>(packed >> 48)};
  }
  /// Not traced yet.
  static constexpr std::uint64_t kUntraced = ~std::uint64_t{0};
};

/// Traces all propellers. (Algorithm 8)
[[nodiscard]] GlobalConnectivity traceOpposites(const igm::PreparedMap& map,
                                                const Array<lattice::NormalSigns>& signs,
                                                const HexVertices& vertices,
                                                const LocalConnectivity& local, Stage& stage);

}  // namespace hexhex::propeller
