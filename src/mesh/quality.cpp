// The scaled Jacobian, as defined by Knupp et al., "The Verdict Geometric Quality Library",
// Sandia Report SAND2007-1751 (2006); and certificates of straight cells in the same pass.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <adjacency/corner_range.hpp>

#include <hexhex/quality.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <mesh/cell_measures.hpp>
#include <mesh/cell_validity.hpp>
#include <mesh/certificates.hpp>

namespace hexhex::mesh {
namespace {

/// Cells per block: a block takes about a twentieth of a millisecond.
constexpr std::size_t kQualityGrain = 1024;

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

/// Triple product of vectors of any length, normalized; 0 if one of them vanishes or is not finite.
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

/// The scaled Jacobian of a cell whose edges are too long or too short for squares.
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

/// Calls use(first, measures, n) for n cells at a time, measured.
template <class Use>
void forCells(const HexMesh& mesh, std::size_t begin, std::size_t end, Stage& stage,
              const Use& use) {
  const MeasureCells measure = measuresOfCells().back();
  CellMeasures measures;
  for (std::size_t c = begin; c < end; c += CellMeasures::kMost) {
    const std::size_t n = std::min(CellMeasures::kMost, end - c);
    const auto cells = std::span(mesh.cells).subspan(c, n);
    Index largest = 0;
    for (const Hex& cell : cells) {
      for (const Index corner : cell) largest = std::max(largest, corner);
    }
    if (largest >= mesh.points.size()) adjacency::requireCornersInRange(mesh, stage);
    // Prefetches the points of the next cells. (Without this, quality takes 5 % longer.)
    for (std::size_t next = c + n; next < std::min(c + 2 * n, end); ++next) {
      for (const Index corner : mesh.cells[next]) __builtin_prefetch(mesh.points.data() + corner);
    }
    measure(mesh.points.data(), cells, measures);
    for (std::size_t i = 0; i < n; ++i) {
      if (measures.inRange[i] == 0) {
        measures.scaled[i] = scaledJacobianOfAnySize(cornersOf(mesh, c + i));
      }
    }
    use(c, measures, n);
  }
}

/// Accumulates the sum in place of the mean.
void addTo(QualitySummary& summary, double value) {
  summary.minimum = std::min(summary.minimum, value);
  summary.mean += value;
  if (value <= 0) ++summary.notPositive;
  // 10 * value is exact enough for -0.9, -0.8, ... to fall into the bins that they start.
  const auto towardsZero = static_cast<int>(10 * value);
  const int bin = 10 + towardsZero - (10 * value < towardsZero ? 1 : 0);
  ++summary.histogram[static_cast<std::size_t>(std::clamp(bin, 0, 19))];
}

/// Summary of `count` values, from the sums of blocks.
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

CellCertificate certificateOf(const HexMesh& mesh, std::size_t cell, const CellMeasures& measures,
                              std::size_t i, const CellValidity& cells) {
  const double error = measures.errorOf(i);
  if (measures.inRange[i] != 0 && measures.least[i] > error) {
    return {Validity::Positive, (measures.least[i] - 2 * error) / measures.volume[i], {}, 0};
  }
  if (measures.inRange[i] != 0 && measures.corner[i] < -error) {
    return {Validity::Refuted, -1, {}, 0};
  }
  return cells.examine(cornersOf(mesh, cell));
}

}  // namespace

}  // namespace hexhex::mesh

namespace hexhex {

double scaledJacobian(const std::array<Vec3, 8>& corners) noexcept {
  mesh::CellMeasures measures;
  const Hex cell = {0, 1, 2, 3, 4, 5, 6, 7};
  mesh::measuresOfCells().back()(corners.data(), std::span(&cell, 1), measures);
  return measures.inRange[0] != 0 ? measures.scaled[0]
                                  : mesh::scaledJacobianOfAnySize(mesh::byPlace(corners));
}

Array<double> scaledJacobians(const HexMesh& mesh, Context& context) {
  return inStage(context, "scaledJacobians", "quality", [&](Stage& stage) {
    Array<double> result(mesh.cells.size());
    withThreads(context.threads(), [&] {
      parallelBlocks(stage, mesh.cells.size(), mesh::kQualityGrain,
                     [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                       mesh::forCells(mesh, begin, end, stage,
                                      [&](std::size_t first, const mesh::CellMeasures& measures,
                                          std::size_t n) {
                                        std::copy_n(measures.scaled.begin(), n, &result[first]);
                                      });
                     });
    });
    return result;
  });
}

QualitySummary summarize(const Array<double>& scaledJacobians) {
  QualitySummary summary;
  if (scaledJacobians.empty()) return summary;
  summary.minimum = scaledJacobians.front();
  for (const double value : scaledJacobians) mesh::addTo(summary, value);
  summary.mean /= static_cast<double>(scaledJacobians.size());
  return summary;
}

CellCertificate certify(const std::array<Vec3, 8>& corners) {
  return mesh::CellValidity(1).findLeast(mesh::byPlace(corners), 1);
}

Certificate certify(const HexMesh& mesh, Context& context) {
  const std::size_t n = mesh.cells.size();
  Certificate certificate;
  if (n == 0) return certificate;
  inStage(context, "certify", "quality", [&](Stage& stage) {
    certificate.scaledJacobians.resize(n);
    certificate.validity.resize(n);
    const mesh::CellValidity cells(1);
    withThreads(context.threads(), [&] {
      std::vector<mesh::BlockFindings> blocks(blockCount(n, mesh::kQualityGrain));
      std::vector<QualitySummary> summaries(blocks.size());
      parallelBlocks(
          stage, n, mesh::kQualityGrain,
          [&](std::size_t begin, std::size_t end, std::size_t block) {
            summaries[block].minimum = 1;
            mesh::forCells(
                mesh, begin, end, stage,
                [&](std::size_t first, const mesh::CellMeasures& measures, std::size_t count) {
                  std::copy_n(measures.scaled.begin(), count, &certificate.scaledJacobians[first]);
                  for (std::size_t i = 0; i < count; ++i)
                    mesh::addTo(summaries[block], measures.scaled[i]);
                  for (std::size_t i = 0; i < count; ++i) {
                    const CellCertificate known =
                        mesh::certificateOf(mesh, first + i, measures, i, cells);
                    certificate.validity[first + i] = known.validity;
                    blocks[block].add(first + i, measures.scaled[i], known);
                  }
                });
          });
      certificate.quality = mesh::united(summaries, n);
      mesh::BlockFindings::finish(
          blocks, cells,
          [&](std::uint64_t cell, std::vector<Vec3>& nodes) {
            const mesh::Corners corners = mesh::cornersOf(mesh, cell);
            nodes.assign(corners.begin(), corners.end());
          },
          stage, certificate);
    });
  });
  return certificate;
}

}  // namespace hexhex
