// Where the lattice points of one tet are in space, to compare vertices with. (The engines place
// them with sweep/tet_positions.)
#pragma once

#include <cmath>
#include <span>

#include <igm/prepare.hpp>

namespace hexhex::verification {

class SpaceOfTet {
 public:
  SpaceOfTet(const igm::PreparedMap& map, Index tet);

  /// Calls strange(i) for each of some points that is not where the map has a lattice point of the
  /// tet, but for rounding.
  /// @param z     the lattice point of the first
  /// @param axis  along which the others follow
  template <class Strange>
  void compare(const lattice::GridPoint& z, std::size_t axis, std::span<const Vec3> points,
               const Strange& strange) const {
    if (isFlat_) {
      lattice::GridPoint here = z;
      for (std::size_t i = 0; i < points.size(); ++i, ++here[axis]) {
        if (!isNear(points[i], exactly(here))) strange(i);
      }
      return;
    }
    const Vec3 first = preimage(z);
    const Vec3& step = steps_[axis];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto n = static_cast<double>(i);
      if (!isNear(points[i],
                  {first[0] + n * step[0], first[1] + n * step[1], first[2] + n * step[2]})) {
        strange(i);
      }
    }
  }

 private:
  [[nodiscard]] Vec3 preimage(const lattice::GridPoint& z) const;
  [[nodiscard]] Vec3 exactly(const lattice::GridPoint& z) const;
  /// False for not-a-number.
  [[nodiscard]] bool isNear(const Vec3& p, const Vec3& q) const noexcept {
    return std::abs(p[0] - q[0]) <= error_ && std::abs(p[1] - q[1]) <= error_ &&
           std::abs(p[2] - q[2]) <= error_;
  }

  const lattice::LatticeTet& corners_;
  std::int64_t unit_;
  std::array<Vec3, 4> points_;
  lattice::GridPoint origin_{};  ///< a grid point near the tet
  Vec3 atOrigin_{};              ///< its preimage
  std::array<Vec3, 3> steps_{};  ///< change of the preimage along each axis
  double error_ = 0;             ///< bound of the error of preimages
  bool isFlat_ = false;          ///< so nearly, in the map, that weights are to be computed exactly
};

}  // namespace hexhex::verification
