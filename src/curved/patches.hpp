// Hex faces as planar polygons, tet by tet (Section 5.5).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <hexhex/curved.hpp>

#include <curved/element_numbers.hpp>
#include <curved/simplex_star.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex::curved {

/// Input of the construction of patches.
struct PatchInput {
  const igm::PreparedMap& map;
  const sweep::VertexTables& vertices;
  const ElementNumbers& edges;
  const ElementNumbers& faces;
  const Arcs& arcs;  ///< of the edges

  /// Number of the first interior point of a face; hex vertices and arc points have smaller
  /// numbers.
  [[nodiscard]] std::uint64_t firstInnerPoint() const noexcept {
    return vertices.count() + arcs.points.size();
  }
};

/// Cuts every hex face once. Generators refer to the map's tets, not to the caller's.
/// @throws Error TooLarge for more points than an Index can number
[[nodiscard]] Patches cutPatches(const PatchInput& input, Stage& stage);

/// An array that is filled again and again, a few elements at a time.
template <class T>
class Column {
 public:
  void clear() noexcept { size_ = 0; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const T* data() const noexcept { return values_.data(); }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return values_[i]; }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return values_[i]; }

  /// Makes room after the last element.
  /// @return where to write; valid until the next call
  [[nodiscard]] T* extend(std::size_t count) {
    const std::size_t begin = size_;
    size_ += count;
    if (size_ > values_.size()) values_.resize(std::max(size_, 2 * values_.size()));
    return values_.data() + begin;
  }
  void add(const T& value) { *extend(1) = value; }

 private:
  Array<T> values_;
  std::size_t size_ = 0;
};

/// Polygons of consecutive hex faces, before their position in the result is known. Interior points
/// are numbered from firstInnerPoint() on.
struct PatchPieces {
  Column<std::uint8_t> cornerCounts;  ///< per polygon
  Column<OwnedSimplex> carriers;      ///< per polygon
  Column<Index> corners;
  Column<std::array<double, 2>> parameters;
  Column<Vec3> points;
  Column<OwnedSimplex> generators;

  void clear() noexcept {
    cornerCounts.clear();
    carriers.clear();
    corners.clear();
    parameters.clear();
    points.clear();
    generators.clear();
  }
};

}  // namespace hexhex::curved
