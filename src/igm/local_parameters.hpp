// The parameters that all stages work with, whatever charts the caller chose.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include <hexhex/types.hpp>

#include <base/prefetch.hpp>
#include <base/vector3.hpp>
#include <igm/input.hpp>

namespace hexhex {

/// Parameters near the origin. Charts may sit far away (translations of 1e9 occur), which would
/// cost fractional bits: each tet's chart is therefore moved by a multiple of `grid`, exactly. The
/// grid is coarse, so that neighbours in one chart nearly always move alike and identity
/// transitions stay identities.
class LocalParameters {
 public:
  /// @param map  must outlive this
  explicit LocalParameters(const OrientedMap& map) noexcept;

  /// Whether coordinates are too large for the arithmetic behind. Nothing but comparisons may then
  /// be done with parameters.
  [[nodiscard]] bool tooLarge() const noexcept { return tooLarge_; }

  [[nodiscard]] Vec3 operator()(Index tet, int corner) const noexcept {
    return at(tet, static_cast<std::size_t>(corner));
  }
  [[nodiscard]] Vec3 at(Index tet, std::size_t corner) const noexcept {
    const TetParameters& parameters = parameters_[tet];
    const Vec3& u = parameters[corner];
    return moved_ ? minus(u, move(parameters)) : u;
  }
  /// All corners of a tet.
  [[nodiscard]] TetParameters operator()(Index tet) const noexcept {
    TetParameters parameters = parameters_[tet];
    if (moved_) {
      const Vec3 by = move(parameters);
      for (Vec3& u : parameters) u = minus(u, by);
    }
    return parameters;
  }
  /// Whether (*this)(tet) is other than what the caller gave.
  [[nodiscard]] bool moved() const noexcept { return moved_; }
  /// What the caller gave.
  [[nodiscard]] const TetParameters& given(Index tet) const noexcept { return parameters_[tet]; }
  /// The multiple of the grid by which a chart is moved that has this coordinate at corner 0.
  [[nodiscard]] double roundedToGrid(double coordinate) const noexcept {
    return std::nearbyint(coordinate / grid_) * grid_;
  }
  /// Asks for the parameters of a tet that will be looked at soon.
  void prefetch(Index tet) const noexcept {
    const TetParameters& parameters = parameters_[tet];
    hexhex::prefetch(&parameters.front());
    hexhex::prefetch(&parameters.back().back());
  }
  /// All corners of a tet, without a copy if they are where the caller has put them.
  /// @param scratch  must outlive the result
  [[nodiscard]] const TetParameters& see(Index tet, TetParameters& scratch) const noexcept {
    return moved_ ? copyTo(scratch, tet) : parameters_[tet];
  }
  /// Largest magnitude of a coordinate.
  [[nodiscard]] double largest() const noexcept { return largest_; }
  /// Largest extent of a tet along an axis.
  [[nodiscard]] double largestExtent() const noexcept { return largestExtent_; }

 private:
  /// Apart, as compilers would otherwise share the copy's loads with the usual case.
  const TetParameters& copyTo(TetParameters& scratch, Index tet) const noexcept;
  [[nodiscard]] Vec3 move(const TetParameters& parameters) const noexcept {
    Vec3 by{};
    for (std::size_t k = 0; k < 3; ++k) by[k] = roundedToGrid(parameters[0][k]);
    return by;
  }

  std::span<const TetParameters> parameters_;
  double grid_ = 0;
  double largest_ = 0;
  double largestExtent_ = 0;
  bool moved_ = false;
  bool tooLarge_ = false;
};

}  // namespace hexhex
