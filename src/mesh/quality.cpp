// The scaled Jacobian, as defined by Knupp et al., "The Verdict Geometric Quality Library",
// Sandia Report SAND2007-1751 (2006).
#include <algorithm>
#include <cmath>

#include <adjacency/hex_topology.hpp>

#include <hexhex/quality.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>

namespace hexhex {
namespace {

/// Cells per block: a block takes about a tenth of a millisecond.
constexpr std::size_t kGrain = 1024;

/// An edge of kHexEdges as seen from one of its ends.
struct EdgeEnd {
  std::uint8_t edge;
  bool backwards;  ///< the corner is the edge's second one
};

/// The three edges at each corner, so that their directions are right-handed in a cube.
constexpr std::array<std::array<EdgeEnd, 3>, 8> edgesAtCorners() {
  constexpr std::array<std::array<std::uint8_t, 3>, 8> kNeighbours = {
      {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
  std::array<std::array<EdgeEnd, 3>, 8> result{};
  for (std::uint8_t corner = 0; corner < 8; ++corner) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t e = 0; e < kHexEdges.size(); ++e) {
        const auto& [from, to] = kHexEdges[e];
        const auto edge = static_cast<std::uint8_t>(e);
        if (from == corner && to == kNeighbours[corner][i]) result[corner][i] = {edge, false};
        if (to == corner && from == kNeighbours[corner][i]) result[corner][i] = {edge, true};
      }
    }
  }
  return result;
}

constexpr std::array<std::array<EdgeEnd, 3>, 8> kEdgesAtCorners = edgesAtCorners();

/// Triple product of vectors with these lengths, normalized; 0 if one of them vanishes or is not
/// finite.
double normalizedProduct(const Vec3& a, const Vec3& b, const Vec3& c, double lengthA,
                         double lengthB, double lengthC) {
  // Lengths are multiplied one by one: a product of squares would underflow below 1e-54 already.
  const double product = tripleProduct(a, b, c) / (lengthA * lengthB * lengthC);
  return std::isfinite(product) ? product : 0.0;
}

/// Sum of four edges of a direction.
Vec3 principalAxis(const std::array<Vec3, 12>& edges, const std::array<std::uint8_t, 4>& parallel) {
  Vec3 sum{};
  for (const std::uint8_t e : parallel) sum = plus(sum, edges[e]);
  return sum;
}

/// The product at the centre.
double centralProduct(const std::array<Vec3, 12>& edges) {
  const Vec3 x = principalAxis(edges, {0, 2, 4, 6});
  const Vec3 y = principalAxis(edges, {3, 1, 7, 5});
  const Vec3 z = principalAxis(edges, {8, 9, 11, 10});
  return normalizedProduct(x, y, z, length(x), length(y), length(z));
}

}  // namespace

double scaledJacobian(const std::array<Vec3, 8>& corners) noexcept {
  // Each edge has two ends: its length is computed once.
  std::array<Vec3, 12> edges;
  std::array<double, 12> lengths;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    edges[e] = minus(corners[kHexEdges[e][1]], corners[kHexEdges[e][0]]);
    lengths[e] = length(edges[e]);
  }
  double smallest = centralProduct(edges);
  for (const auto& [a, b, c] : kEdgesAtCorners) {
    const double product = normalizedProduct(edges[a.edge], edges[b.edge], edges[c.edge],
                                             lengths[a.edge], lengths[b.edge], lengths[c.edge]);
    // Each edge that comes in rather than goes out changes the sign.
    const bool turned = a.backwards != (b.backwards != c.backwards);
    smallest = std::min(smallest, turned ? -product : product);
  }
  return std::clamp(smallest, -1.0, 1.0);  // rounding may lead beyond
}

Array<double> scaledJacobians(const HexMesh& mesh, Context& context) {
  Stage stage(context, "quality");
  Array<double> result(mesh.cells.size());
  withThreads(context.threads(), [&] {
    requireCornersInRange(mesh, stage);
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
