// The scaled Jacobian, as defined by Knupp et al., "The Verdict Geometric Quality Library",
// Sandia Report SAND2007-1751 (2006).
#include <algorithm>
#include <cmath>

#include <hexhex/quality.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>

namespace hexhex {
namespace {

/// Cells per block: a block takes about a tenth of a millisecond.
constexpr std::size_t kGrain = 1024;

/// The three neighbours of each corner, so that their directions are right-handed in a cube.
constexpr std::array<std::array<std::uint8_t, 3>, 8> kNeighbours = {
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

/// Triple product of the normalized vectors; 0 if one of them vanishes or is not finite.
double normalizedProduct(const Vec3& a, const Vec3& b, const Vec3& c) {
  // Lengths are multiplied one by one: a product of squares would underflow below 1e-54 already.
  const double product = dot(a, cross(b, c)) / (length(a) * length(b) * length(c));
  return std::isfinite(product) ? product : 0.0;
}

/// Sum of the four edges of a direction; `from` are their first corners, `to` their last.
Vec3 principalAxis(const std::array<Vec3, 8>& p, const std::array<std::uint8_t, 4>& from,
                   const std::array<std::uint8_t, 4>& to) {
  Vec3 sum{};
  for (std::size_t i = 0; i < 4; ++i) sum = plus(sum, minus(p[to[i]], p[from[i]]));
  return sum;
}

}  // namespace

double scaledJacobian(const std::array<Vec3, 8>& corners) noexcept {
  double smallest = normalizedProduct(principalAxis(corners, {0, 3, 4, 7}, {1, 2, 5, 6}),
                                      principalAxis(corners, {0, 1, 4, 5}, {3, 2, 7, 6}),
                                      principalAxis(corners, {0, 1, 2, 3}, {4, 5, 6, 7}));
  for (std::size_t k = 0; k < 8; ++k) {
    const auto& [i, j, l] = kNeighbours[k];
    smallest = std::min(
        smallest, normalizedProduct(minus(corners[i], corners[k]), minus(corners[j], corners[k]),
                                    minus(corners[l], corners[k])));
  }
  return std::clamp(smallest, -1.0, 1.0);  // rounding may lead beyond
}

Array<double> scaledJacobians(const HexMesh& mesh, Context& context) {
  Stage stage(context, "quality");
  Array<double> result(mesh.cells.size());
  withThreads(context.threads(), [&] {
    parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) {
      std::array<Vec3, 8> corners;
      for (std::size_t k = 0; k < 8; ++k) corners[k] = mesh.points[mesh.cells[c][k]];
      result[c] = scaledJacobian(corners);
    });
  });
  return result;
}

QualitySummary summarize(const Array<double>& scaledJacobians) {
  QualitySummary summary;
  if (scaledJacobians.empty()) return summary;
  summary.minimum = scaledJacobians.front();
  double sum = 0;
  for (const double value : scaledJacobians) {
    summary.minimum = std::min(summary.minimum, value);
    sum += value;
    if (value <= 0) ++summary.notPositive;
    // 10 * value is exact enough for -0.9, -0.8, ... to fall in the bins that they begin.
    const double bin = std::clamp(std::floor(10 * value) + 10, 0.0, 19.0);
    ++summary.histogram[static_cast<std::size_t>(bin)];
  }
  summary.mean = sum / static_cast<double>(scaledJacobians.size());
  return summary;
}

}  // namespace hexhex
