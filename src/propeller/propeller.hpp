// The propeller engine, which is the paper's: the sequence of its stages after preprocessing, and
// the last two of them. Each hex edge is traced once, from vertex to vertex, and the eight corners
// of each cell are collected by walking from propeller to opposite (Section 5.4).
#pragma once

#include <cstdint>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <propeller/local_connectivity.hpp>

namespace hexhex::propeller {

/// Where a global propeller (hex vertex, local propeller) leads: its opposite, and the connection
/// offset, by which blade i corresponds to blade (offset - i) of the opposite, modulo their number.
struct Opposite {
  Index vertex;
  std::uint16_t propeller;
  std::uint16_t offset;
};

/// The global propellers of a vertex are consecutive, and so are those of all vertices of a
/// generator.
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

/// Number of cells that the hex corners of all vertices form.
[[nodiscard]] std::uint64_t countCells(const HexVertices& vertices, const LocalConnectivity& local);

/// All cells in canonical order (sweep/cell_order.hpp). Each is entered from its centre at its
/// first corner; from there the walk goes from propeller to opposite.
[[nodiscard]] Array<Hex> collectCells(const igm::PreparedMap& map,
                                      const Array<lattice::NormalSigns>& signs,
                                      const HexVertices& vertices, const LocalConnectivity& local,
                                      const GlobalConnectivity& global, Stage& stage);

/// Extracts the mesh of a map that has passed all checks and is scaled.
/// @param expectedCells  the map's parametric volume
/// @param epsilon        as in extraction::EngineOptions
/// @param[in,out] statistics  receives what the stages count
[[nodiscard]] HexMesh runPipeline(const igm::PreparedMap& map, std::uint64_t expectedCells,
                                  double epsilon, Context& context, ExtractStatistics& statistics);

}  // namespace hexhex::propeller
