// Changes between charts of a seamless map: rotations of the grid, and any translation.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <lattice/rotation.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::quantization {

/// u -> R u + t, exactly, with coordinates on a lattice: units for a seamless map, integers for a
/// quantized one.
struct ChartChange {
  lattice::Rotation rotation;
  lattice::LatticePoint translation{};

  [[nodiscard]] constexpr bool operator==(const ChartChange&) const = default;
  [[nodiscard]] constexpr bool isIdentity() const noexcept { return *this == ChartChange{}; }

  [[nodiscard]] constexpr lattice::LatticePoint operator()(
      const lattice::LatticePoint& u) const noexcept {
    return rotation(u) + translation;
  }
  [[nodiscard]] constexpr ChartChange inverse() const noexcept {
    const lattice::Rotation back = rotation.inverse();
    return {back, -back(translation)};
  }
  /// Composition: (a * b)(u) = a(b(u)).
  friend constexpr ChartChange operator*(const ChartChange& a, const ChartChange& b) noexcept {
    return {a.rotation * b.rotation, a(b.translation)};
  }
};

/// A change for each half-face: nearly all are the identity, and those across a patch of a cut one.
class FaceChanges {
 public:
  explicit FaceChanges(std::size_t halfFaces = 0) : places_(halfFaces, 0) {}

  [[nodiscard]] const ChartChange& operator[](adjacency::HalfFace h) const noexcept {
    return distinct_[places_[h]];
  }
  void set(adjacency::HalfFace h, const ChartChange& change) {
    const auto [found, isNew] = placeOf_.try_emplace({change.rotation.index(), change.translation},
                                                     static_cast<Index>(distinct_.size()));
    if (isNew) distinct_.push_back(change);
    places_[h] = found->second;
  }
  /// Leaves no room to grow.
  void shrink() { places_.shrink_to_fit(); }
  void appendCopyOf(adjacency::HalfFace h) { places_.push_back(Index{places_[h]}); }

 private:
  std::vector<Index> places_;  ///< in `distinct_`, per half-face
  std::vector<ChartChange> distinct_ = {{}};
  std::map<std::pair<int, lattice::LatticePoint>, Index> placeOf_ = {{{0, {}}, 0}};
};

}  // namespace hexhex::quantization
