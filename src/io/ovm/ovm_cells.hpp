// Maps and hex meshes, whose cells are lists of corners, from and to polyhedral meshes, whose cells
// are lists of half-faces.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex {

/// The map of a tet mesh.
/// @param fileName  for error messages
/// @throws Error FileUnsupported if a cell is no tet or there is no map; FileSyntax if cells are
///         wrong; NotFinite
[[nodiscard]] TetMap toTetMap(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// The same tets without a map, whether there is one or not.
[[nodiscard]] TetCells toTetCells(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// The cells of a hex mesh. Half-faces may come in any order; if most cells are inside out, all are
/// turned.
/// @throws Error FileUnsupported if a cell is no hexahedron; FileSyntax if cells are wrong
[[nodiscard]] HexMesh toHexMesh(OvmMesh&& mesh, const std::string& fileName, Stage& stage);

/// What a file holds. Half-faces point into their cells, and the first slots of cells begin with
/// the cells' corners where neighbours allow it; elsewhere, the property CornerOrder tells the
/// order.
/// @param mesh  with corners and generators in range
/// @throws Error InvalidArgument if arrays disagree, or features and valences name what is not in
///         the mesh; IndexOutOfRange, RepeatedVertex, NotFinite, NonManifoldFace, Orientation,
///         TooLarge
[[nodiscard]] OvmOutput toOvm(const TetMap& map, Stage& stage);
[[nodiscard]] OvmOutput toOvm(const HexMesh& mesh, Stage& stage);

/// The topology of a map's file.
/// @param tets  with vertices in range
[[nodiscard]] OvmTopology ovmTopologyOf(std::span<const Vec3> points, std::span<const Tet> tets,
                                        Stage& stage);

/// Whether valueOf(i) is negative for more of the i in [0, n) than it is positive.
template <class F>
[[nodiscard]] bool areMostlyNegative(Stage& stage, std::size_t n, const F& valueOf) {
  constexpr std::size_t kGrain = 4096;
  std::atomic<std::int64_t> balance{0};
  parallelBlocks(stage, n, kGrain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    std::int64_t local = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double value = valueOf(i);
      local += value > 0 ? 1 : (value < 0 ? -1 : 0);
    }
    balance.fetch_add(local, std::memory_order_relaxed);
  });
  return balance.load() < 0;
}

/// Whether two corners are the same vertex.
template <std::size_t corners>
[[nodiscard]] bool hasVertexTwice(const std::array<Index, corners>& cell) noexcept {
  Index alike = 0;  // pairs of corners, each with itself among them
  for (const Index a : cell) {
    for (const Index b : cell) alike += a == b ? 1U : 0U;
  }
  return alike > corners;
}

/// Orders of a hexahedron's corners, which the property CornerOrder numbers. The first face is
/// always the same: 0 to 3 begin with that corner of it, 4 to 7 go round in the other direction.
inline constexpr std::size_t kHexOrders = 8;
[[nodiscard]] Hex inHexOrder(const Hex& assembled, std::size_t order) noexcept;

/// The n vertices of a face, in loop order; all are kNone if it has no closed loop of n half-edges.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfFace(const OvmTopology& topology, std::size_t face) {
  const std::span<const Index> halfEdges = topology.faces[face];
  std::array<Index, n> loop;
  loop.fill(kNone);
  if (halfEdges.size() != n) return loop;
  const std::array<Index, 2>& last = topology.edges[halfEdges[n - 1] / 2];
  Index to = last[1 - halfEdges[n - 1] % 2];
  bool closed = true;
  for (std::size_t i = 0; i < n; ++i) {
    const std::array<Index, 2>& edge = topology.edges[halfEdges[i] / 2];
    loop[i] = edge[halfEdges[i] % 2];
    closed = closed && loop[i] == to;
    to = edge[1 - halfEdges[i] % 2];
  }
  if (!closed) loop.fill(kNone);
  return loop;
}

/// The same of a half-face, given the loop of its face.
template <std::size_t n>
[[nodiscard]] std::array<Index, n> loopOfHalfFace(const std::array<Index, n>& ofFace,
                                                  Index halfFace) noexcept {
  if (halfFace % 2 == 0) return ofFace;
  std::array<Index, n> reversed;
  for (std::size_t i = 0; i < n; ++i) reversed[i] = ofFace[(n - i) % n];
  return reversed;
}

}  // namespace hexhex
