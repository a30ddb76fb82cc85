// The positive substitute for determinants in foldover-free energies.
//
// V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
// 50 lines of code", ACM Transactions on Graphics 40 (2021):
//
//     chi(det) = (det + root) / 2,  root = sqrt(epsilon^2 + det^2),
//
// which is close to det if that is positive, and close to 0 if it is negative. Its derivative is
// chi / root.
//
// Two energies use it, whose shape terms are powers of each other. |J|^2 / chi^(2/3), as in the
// paper, is that of the solver for all unknowns (foldover_energy.hpp), with derivatives by four
// corners. |J|^3 / chi is that of steps of one vertex (improve/vertex_energy.hpp): it takes no cube
// root, and is convex in the vertex. In place of the other, either would change all results, and
// elements of four corners would be measured for one that moves.
#pragma once

#include <base/lanes.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // everything is inline
#endif

namespace hexhex::untangle {

/// chi as a fraction, for which nothing cancels: (root + det) (root - det) = epsilon^2.
/// @tparam V  lanes of doubles
template <class V>
struct alignas(sizeof(V)) Regularized {
  V root;
  V numerator;
  V denominator;

  /// @param epsilon  0 if all determinants are positive: then, chi = det
  HEXHEX_INLINE Regularized(double epsilon, const V& det) noexcept
      : root(rootOf<V>(epsilon * epsilon + det * det)),
        numerator(wherePositive(det, 0.5 * (det + root), V{} + 0.5 * epsilon * epsilon)),
        denominator(wherePositive(det, V{} + 1, root - det)) {}

  [[nodiscard]] HEXHEX_INLINE V chi() const noexcept { return numerator / denominator; }
  [[nodiscard]] HEXHEX_INLINE V inverse() const noexcept { return denominator / numerator; }
};

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

}  // namespace hexhex::untangle
