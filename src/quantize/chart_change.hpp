// Changes between charts of a seamless map: rotations of the grid, and any translation.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <lattice/rotation.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex {

[[nodiscard]] constexpr LatticePoint operator+(const LatticePoint& a,
                                               const LatticePoint& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

[[nodiscard]] constexpr LatticePoint operator-(const LatticePoint& a) noexcept {
  return {-a[0], -a[1], -a[2]};
}

/// u -> R u + t, exactly, with coordinates on a lattice: units for a seamless map, integers for a
/// quantized one.
struct ChartChange {
  Rotation rotation;
  LatticePoint translation{};

  [[nodiscard]] constexpr bool operator==(const ChartChange&) const = default;
  [[nodiscard]] constexpr bool isIdentity() const noexcept { return *this == ChartChange{}; }

  [[nodiscard]] constexpr LatticePoint operator()(const LatticePoint& u) const noexcept {
    return rotation(u) + translation;
  }
  [[nodiscard]] constexpr ChartChange inverse() const noexcept {
    const Rotation back = rotation.inverse();
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

  [[nodiscard]] const ChartChange& operator[](HalfFace h) const noexcept {
    return distinct_[places_[h]];
  }
  void set(HalfFace h, const ChartChange& change) {
    const auto [found, isNew] = placeOf_.try_emplace({change.rotation.index(), change.translation},
                                                     static_cast<Index>(distinct_.size()));
    if (isNew) distinct_.push_back(change);
    places_[h] = found->second;
  }
  void appendCopyOf(HalfFace h) { places_.push_back(Index{places_[h]}); }

 private:
  std::vector<Index> places_;  ///< in `distinct_`, per half-face
  std::vector<ChartChange> distinct_ = {{}};
  std::map<std::pair<int, LatticePoint>, Index> placeOf_ = {{{0, {}}, 0}};
};

}  // namespace hexhex
