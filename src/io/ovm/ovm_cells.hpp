// Cells as lists of corners, from cells as lists of half-faces.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <hexhex/types.hpp>

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

/// A cell that was read: its corners, and half-face s of its list is opposite corner `opposite[s]`.
struct OvmTet {
  Tet corners{};
  std::array<std::uint8_t, 4> opposite{};
};

/// The tet with the four half-faces: the loop of the first one, then the vertex opposite it.
/// @param loops  three vertices of each half-face in order
/// @return false if they do not bound a tet
[[nodiscard]] bool assembleTet(const std::array<std::array<Index, 3>, 4>& loops,
                               OvmTet& tet) noexcept;

/// Whether two corners are the same vertex, of fewer than 2^31. Without branches, and two pairs of
/// corners at once, since it is asked of every cell.
template <std::size_t corners>
[[nodiscard]] bool hasVertexTwice(const std::array<Index, corners>& cell) noexcept {
  constexpr std::uint64_t kOnes = 0x0000000100000001U;
  constexpr std::uint64_t kSigns = 0x8000000080000000U;
  const auto pairs = std::bit_cast<std::array<std::uint64_t, corners / 2>>(cell);
  std::uint64_t equal = 0;
  // No difference has a sign, so that one appears where 1 is taken from none.
  const auto compare = [&equal](std::uint64_t a, std::uint64_t b) { equal |= (a ^ b) - kOnes; };
  for (std::size_t i = 0; i < corners / 2; ++i) {
    const std::uint64_t exchanged = std::rotl(pairs[i], 32);
    compare(pairs[i], exchanged);
    for (std::size_t k = i + 1; k < corners / 2; ++k) {
      compare(pairs[i], pairs[k]);
      compare(exchanged, pairs[k]);
    }
  }
  return (equal & kSigns) != 0;
}

/// The hexahedron with the six half-faces in VTK's order: the loop of the first one, then the
/// vertices that edges join to them. Positive if loops run counter-clockwise seen from inside.
/// @return false if they do not bound a hexahedron
[[nodiscard]] bool assembleHex(const std::array<std::array<Index, 4>, 6>& loops, Hex& hex) noexcept;

/// Whether most hexahedra have a negative volume (that of their mean edge vectors). Of a large
/// mesh, some tens of thousands are asked.
[[nodiscard]] bool isMostlyNegative(std::span<const Vec3> points, std::span<const Hex> cells,
                                    Stage& stage);

/// Even and odd orders of a tet's corners, which the property CornerOrder numbers: corner i of the
/// listed tet is corner kTetOrders[n][i] of the assembled one. Number 0 changes nothing.
inline constexpr std::array<std::array<std::uint8_t, 4>, 24> kTetOrders = {
    {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1},
     {1, 0, 2, 3}, {1, 0, 3, 2}, {1, 2, 0, 3}, {1, 2, 3, 0}, {1, 3, 0, 2}, {1, 3, 2, 0},
     {2, 0, 1, 3}, {2, 0, 3, 1}, {2, 1, 0, 3}, {2, 1, 3, 0}, {2, 3, 0, 1}, {2, 3, 1, 0},
     {3, 0, 1, 2}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 1, 2, 0}, {3, 2, 0, 1}, {3, 2, 1, 0}}};

/// The same for hexahedra, whose first face is always the assembled one's: 0 to 3 begin with that
/// corner of it, 4 to 7 go round in the other direction.
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

/// The three or four vertices of all faces, in loop order, from the half-face 2f on.
template <std::size_t n>
class OvmLoops {
 public:
  OvmLoops(const OvmTopology& topology, Stage& stage);

  /// Whether face f has n vertices and a closed loop.
  [[nodiscard]] bool isGood(std::size_t face) const noexcept { return loops_[face][0] != kNone; }
  [[nodiscard]] const std::array<Index, n>& ofFace(std::size_t face) const noexcept {
    return loops_[face];
  }
  [[nodiscard]] std::array<Index, n> ofHalfFace(Index halfFace) const noexcept {
    return loopOfHalfFace(loops_[halfFace / 2], halfFace);
  }

 private:
  Array<std::array<Index, n>> loops_;
};

/// Throws unless all cells have this number of half-faces, none is in two cells, and all have good
/// loops.
template <std::size_t n>
void requireProperCells(const OvmTopology& topology, const OvmLoops<n>& loops, std::size_t valence,
                        const std::string& fileName, const char* wanted, Stage& stage);

}  // namespace hexhex
