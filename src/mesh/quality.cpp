// The scaled Jacobian, as defined by Knupp et al., "The Verdict Geometric Quality Library",
// Sandia Report SAND2007-1751 (2006); and certificates of straight cells in the same pass.
#include <algorithm>
#include <cmath>
#include <utility>

#include <adjacency/hex_topology.hpp>

#include <hexhex/quality.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <mesh/cell_pair.hpp>
#include <mesh/cell_validity.hpp>
#include <mesh/certificates.hpp>

namespace hexhex {
namespace {

/// Cells per block: a block takes about a twentieth of a millisecond.
constexpr std::size_t kGrain = 1024;

/// Corners by their place (u, v, w) in bits 0, 1, 2.
using Corners = std::array<Vec3, 8>;

Corners byPlace(const std::array<Vec3, 8>& vtkCorners) {
  Corners corners;
  for (std::size_t place = 0; place < 8; ++place) corners[place] = vtkCorners[kVtkCorner[place]];
  return corners;
}

Corners cornersOf(const HexMesh& mesh, std::size_t cell) {
  Corners corners;
  for (std::size_t place = 0; place < 8; ++place) {
    corners[place] = mesh.points[mesh.cells[cell][kVtkCorner[place]]];
  }
  return corners;
}

/// Triple product of vectors of any lengths, normalized; 0 if one of them vanishes or is not
/// finite.
double normalizedProduct(std::array<Vec3, 3> vectors) {
  double lengths = 1;
  for (Vec3& v : vectors) {
    int exponent = 0;
    static_cast<void>(
        std::frexp(std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}), &exponent));
    for (double& x : v) x = std::ldexp(x, -exponent);
    lengths *= length(v);
  }
  const double product = tripleProduct(vectors[0], vectors[1], vectors[2]) / lengths;
  return std::isfinite(product) ? product : 0.0;
}

/// The scaled Jacobian of a cell whose edges are too long or short for squares.
double scaledJacobianOfAnySize(const Corners& corners) {
  double smallest = 1;
  std::array<Vec3, 3> axes{};
  for (std::size_t place = 0; place < 8; ++place) {
    std::array<Vec3, 3> edges;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t bit = std::size_t{1} << axis;
      edges[axis] = minus(corners[place | bit], corners[place & ~bit]);
      for (std::size_t k = 0; k < 3; ++k) axes[axis][k] += edges[axis][k] / 8;
    }
    smallest = std::min(smallest, normalizedProduct(edges));
  }
  return std::clamp(std::min(smallest, normalizedProduct(axes)), -1.0, 1.0);
}

/// @param corner  (which cell, place): a corner of one of two cells
template <class CornerAt>
PairQuality qualityOf(const CornerAt& corner) {
  std::array<PairVector, 8> at;
  for (std::size_t place = 0; place < 8; ++place) {
    const Vec3& first = corner(0, place);
    const Vec3& second = corner(1, place);
    for (std::size_t k = 0; k < 3; ++k) at[place][k] = Pair{first[k], second[k]};
  }
  return measurePair(at);
}

/// @param corners  gives those of the cell, where they are needed
template <class CornersOf>
double scaledJacobianOf(const PairQuality& quality, std::size_t which, const CornersOf& corners) {
  if (quality.inRange[which] == 0) return scaledJacobianOfAnySize(corners());
  return std::clamp(quality.scaled[which], -1.0, 1.0);  // rounding may lead beyond
}

/// Calls use(cell, scaled Jacobian, quality of two cells, which of them).
template <class Use>
void forCells(const HexMesh& mesh, std::size_t begin, std::size_t end, const Use& use) {
  for (std::size_t c = begin; c < end; c += 2) {
    const std::size_t count = std::min<std::size_t>(2, end - c);
    const std::array<const Hex*, 2> cells = {&mesh.cells[c], &mesh.cells[c + count - 1]};
    const PairQuality quality = qualityOf([&](std::size_t which, std::size_t place) -> const Vec3& {
      return mesh.points[(*cells[which])[kVtkCorner[place]]];
    });
    for (std::size_t which = 0; which < count; ++which) {
      const auto corners = [&] { return cornersOf(mesh, c + which); };
      use(c + which, scaledJacobianOf(quality, which, corners), quality, which);
    }
  }
}

/// With the sum in place of the mean.
void addTo(QualitySummary& summary, double value) {
  summary.minimum = std::min(summary.minimum, value);
  summary.mean += value;
  if (value <= 0) ++summary.notPositive;
  // 10 * value is exact enough for -0.9, -0.8, ... to fall in the bins that they begin.
  const double bin = std::clamp(std::floor(10 * value) + 10, 0.0, 19.0);
  ++summary.histogram[static_cast<std::size_t>(bin)];
}

/// Of `count` values, from the sums of blocks.
QualitySummary united(const std::vector<QualitySummary>& blocks, std::size_t count) {
  QualitySummary all;
  all.minimum = 1;
  for (const QualitySummary& block : blocks) {
    all.minimum = std::min(all.minimum, block.minimum);
    all.mean += block.mean;
    all.notPositive += block.notPositive;
    for (std::size_t i = 0; i < all.histogram.size(); ++i) all.histogram[i] += block.histogram[i];
  }
  all.mean /= static_cast<double>(count);
  return all;
}

void judge(const HexMesh& mesh, std::size_t cell, double scaled, const PairQuality& quality,
           std::size_t which, const CellValidity& cells, Certificate& certificate,
           BlockFindings& findings) {
  CellCertificate known = {Validity::Positive, -1, {}, 0};
  const double error = quality.error[which];
  if (quality.inRange[which] != 0 && quality.least[which] > error) {
    known.minimum = (quality.least[which] - 2 * error) / quality.volume[which];
  } else if (quality.inRange[which] != 0 && quality.corner[which] < -error) {
    known.validity = Validity::Refuted;
  } else {
    known = cells.examine(cornersOf(mesh, cell));
  }
  certificate.validity[cell] = known.validity;
  findings.add(cell, scaled, known);
}

}  // namespace

double scaledJacobian(const std::array<Vec3, 8>& corners) noexcept {
  const Corners ordered = byPlace(corners);
  const PairQuality quality = qualityOf(
      [&](std::size_t /*which*/, std::size_t place) -> const Vec3& { return ordered[place]; });
  return scaledJacobianOf(quality, 0, [&] { return ordered; });
}

Array<double> scaledJacobians(const HexMesh& mesh, Context& context) {
  Stage stage(context, "quality");
  Array<double> result(mesh.cells.size());
  withThreads(context.threads(), [&] {
    requireCornersInRange(mesh, stage);
    parallelBlocks(
        stage, mesh.cells.size(), kGrain,
        [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
          forCells(mesh, begin, end,
                   [&](std::size_t cell, double scaled, const auto&...) { result[cell] = scaled; });
        });
  });
  return result;
}

QualitySummary summarize(const Array<double>& scaledJacobians) {
  QualitySummary summary;
  if (scaledJacobians.empty()) return summary;
  summary.minimum = scaledJacobians.front();
  for (const double value : scaledJacobians) addTo(summary, value);
  summary.mean /= static_cast<double>(scaledJacobians.size());
  return summary;
}

CellCertificate certify(const std::array<Vec3, 8>& corners) {
  return CellValidity(1).findLeast(byPlace(corners), 1);
}

Certificate certify(const HexMesh& mesh, Context& context) {
  Stage stage(context, "quality");
  const std::size_t n = mesh.cells.size();
  Certificate certificate;
  if (n == 0) return certificate;
  certificate.scaledJacobians.resize(n);
  certificate.validity.resize(n);
  const CellValidity cells(1);
  withThreads(context.threads(), [&] {
    requireCornersInRange(mesh, stage);
    std::vector<BlockFindings> blocks(blockCount(n, kGrain));
    std::vector<QualitySummary> summaries(blocks.size());
    parallelBlocks(stage, n, kGrain, [&](std::size_t begin, std::size_t end, std::size_t block) {
      summaries[block].minimum = 1;
      forCells(mesh, begin, end,
               [&](std::size_t cell, double scaled, const PairQuality& quality, std::size_t which) {
                 certificate.scaledJacobians[cell] = scaled;
                 addTo(summaries[block], scaled);
                 judge(mesh, cell, scaled, quality, which, cells, certificate, blocks[block]);
               });
    });
    certificate.quality = united(summaries, n);
    BlockFindings::finish(
        blocks, cells,
        [&](std::uint64_t cell, std::vector<Vec3>& nodes) {
          const Corners corners = cornersOf(mesh, cell);
          nodes.assign(corners.begin(), corners.end());
        },
        stage, certificate);
  });
  return certificate;
}

}  // namespace hexhex
