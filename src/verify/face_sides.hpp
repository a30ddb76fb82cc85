// On which sides of its faces do points near a tet lie, and through which one does a segment leave?
// For many points: by planes in floating point with a proven bound, and by the exact predicate
// where that cannot tell.
#pragma once

#include <algorithm>

#include <lattice/tet_geometry.hpp>

namespace hexhex::verification {

class FaceSides {
 public:
  /// Rounded, one for each face: positive inside.
  using Values = std::array<double, 4>;

  /// Where a point is.
  struct Place {
    lattice::CornerMask simplex;  ///< that has the point in its interior, if it is in the tet
    unsigned beyond;              ///< the faces that it is beyond: a bit each
    Values values;
  };

  /// @param step  all points are multiples of this, and at most this far from the tet's bounding
  /// box
  FaceSides(const lattice::LatticeTet& tet, std::int64_t step) noexcept : tet_(tet) {
    std::int64_t bits = step;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const lattice::LatticePoint& p : tet) bits |= p[k];
      const auto [low, high] = std::minmax({tet[0][k], tet[1][k], tet[2][k], tet[3][k]});
      low_[k] = low - step;
      high_[k] = high + step;
    }
    for (std::size_t f = 0; f < 4; ++f) {
      const auto corner = [&](std::size_t i) {
        return tet[static_cast<std::size_t>(lattice::kFaceCorners[f][i])];
      };
      const lattice::LatticePoint u = corner(1) - corner(0);
      const lattice::LatticePoint v = corner(2) - corner(0);
      double magnitude = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        normals_[k][f] = lattice::signedToDouble(lattice::crossComponent(u, v, k));
        // All faces but the first one go through corner 0.
        if (f == 0) atOrigin_ -= normals_[k][0] * static_cast<double>(tet[1][k] - tet[0][k]);
        magnitude += 2 * std::abs(normals_[k][f]) * static_cast<double>(high_[k] - low_[k]);
      }
      // Each of six terms carries four roundings, and their sum five more: less than 2^-49.
      error_[f] = magnitude < lattice::exactBelow(bits) ? 0 : 0x1p-49 * magnitude;
    }
  }

  [[nodiscard]] Values valuesAt(const lattice::LatticePoint& point) const noexcept {
    Values values{atOrigin_};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto offset = static_cast<double>(point[k] - tet_[0][k]);
      for (std::size_t f = 0; f < 4; ++f) values[f] += normals_[k][f] * offset;
    }
    return values;
  }

  [[nodiscard]] Place placeOf(const lattice::LatticePoint& point) const noexcept {
    Place place{lattice::kNoSimplex, 0, valuesAt(point)};
    unsigned inside = 0;
    for (std::size_t f = 0; f < 4; ++f) {
      inside |= (place.values[f] > error_[f] ? 1U : 0U) << f;
      place.beyond |= (place.values[f] < -error_[f] ? 1U : 0U) << f;
    }
    const unsigned open = lattice::kWholeTet ^ inside ^ place.beyond;
    for (std::size_t f = 0; f < 4 && open != 0; ++f) {
      if ((open >> f & 1U) == 0 || error_[f] == 0) continue;
      const int side = lattice::sideOfFace(tet_, f, point);
      inside |= (side > 0 ? 1U : 0U) << f;
      place.beyond |= (side < 0 ? 1U : 0U) << f;
    }
    // A point off the face opposite a corner has a positive barycentric coordinate there.
    place.simplex = static_cast<lattice::CornerMask>(inside);
    return place;
  }

  /// The simplex that has a point, anywhere, in its interior, or kNoSimplex outside of the tet.
  [[nodiscard]] lattice::CornerMask simplexOf(const lattice::LatticePoint& point) const noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      if (point[k] < low_[k] || point[k] > high_[k]) return lattice::kNoSimplex;
    }
    const Place place = placeOf(point);
    return place.beyond == 0 ? place.simplex : lattice::kNoSimplex;
  }

  /// The face through which a segment leaves the tet, or any of several if that is through an edge
  /// or a vertex; kNoExit if it is not certain.
  /// @param start  in the closed tet
  /// @param end    outside of it
  [[nodiscard]] int exit(const lattice::LatticePoint& start, const Place& end) const noexcept {
    auto first = static_cast<std::size_t>(std::countr_zero(end.beyond));
    if (end.beyond == 1U << first) return static_cast<int>(first);
    const Values from = valuesAt(start);
    for (std::size_t f = first + 1; f < 4; ++f) {
      if ((end.beyond >> f & 1U) == 0) continue;
      // It meets a plane after a share from / (from - to) of its way.
      const double one = from[f] * end.values[first];
      const double other = from[first] * end.values[f];
      const double error = error_[f] * (std::abs(end.values[first]) + std::abs(from[first])) +
                           error_[first] * (std::abs(end.values[f]) + std::abs(from[f])) +
                           4 * error_[f] * error_[first] +
                           0x1p-50 * (std::abs(one) + std::abs(other));
      if (std::abs(one - other) <= error) return lattice::kNoExit;
      if (one > other) first = f;
    }
    return static_cast<int>(first);
  }

 private:
  const lattice::LatticeTet& tet_;
  lattice::LatticePoint low_;  ///< corners of the box in which errors hold
  lattice::LatticePoint high_;
  std::array<Values, 3> normals_;  ///< inwards, by axis and face, to within 2^-52
  double atOrigin_ = 0;            ///< value of the first face at corner 0
  Values error_;                   ///< bounds; 0 if all values are exact
};

}  // namespace hexhex::verification
