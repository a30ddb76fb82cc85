// Distortion of Lagrange cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <hexhex/curved.hpp>

#include <base/parallel.hpp>
#include <base/register_widths.hpp>
#include <curved/lagrange.hpp>
#include <curved/lagrange_quality.hpp>
#include <mesh/certificates.hpp>
#include <mesh/lagrange_check.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace hexhex::curved {

namespace {

constexpr std::size_t kLagrangeQualityGrain = 64;

void nodesOf(const LagrangeMesh& mesh, std::size_t cell, std::vector<Vec3>& nodes) {
  nodes.resize(mesh.nodesPerCell());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = mesh.points[mesh.nodes[cell * nodes.size() + i]];
  }
}

/// Gauss points in [0, 1]: zeros of the Legendre polynomial of degree n, by Newton's method.
std::vector<double> gaussPoints(int n) {
  std::vector<double> places;
  for (int i = n; i >= 1; --i) {
    double x = std::cos(std::numbers::pi * (i - 0.25) / (n + 0.5));
    for (int iteration = 0; iteration < 20; ++iteration) {
      double before = 1;
      double now = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
        before = now;
        now = next;
      }
      const double slope = n * (x * now - before) / (x * x - 1);
      x -= now / slope;
    }
    places.push_back((1 + x) / 2);
  }
  return places;
}

using Smallest = std::array<double, kCellLanes>;

[[gnu::always_inline]] inline CellNumber lengthOf(const LaneVector<CellNumber>& a) noexcept {
  return rootOf<CellNumber>(dot(a, a));
}

/// Lowers numbers to the smallest scaled determinants on a grid.
[[gnu::always_inline]] inline void lower(const LagrangeColumns& grid, const LagrangeCells& cells,
                                         LagrangeScratch& scratch, Smallest& smallest) {
  forColumns(
      grid, cells, scratch, [&](const auto& /*rows*/, const auto& u, const auto& v, const auto& w) {
        const CellNumber scaled = dot(u, cross(v, w)) / (lengthOf(u) * lengthOf(v) * lengthOf(w));
        for (std::size_t i = 0; i < kCellLanes; ++i) {
          smallest[i] = std::min(smallest[i], std::isfinite(scaled[i]) ? scaled[i] : 0.0);
        }
      });
}

using Lower = void (*)(const LagrangeColumns&, const LagrangeCells&, LagrangeScratch&, Smallest&);

/// lower() for the widest registers.
Lower widestLower() noexcept {
  static constexpr std::array<Lower, 2> kBoth = {lower, kWide<lower>};
  return runnable(kBoth).back();
}

/// Calls use(cell, its scaled Jacobian, block) for all cells.
template <class Use>
void forCells(const LagrangeMesh& mesh, Stage& stage, const Use& use) {
  const LagrangeQuality quality(mesh.order);
  parallelBlocks(stage, mesh.cellCount(), kLagrangeQualityGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   LagrangeScratch scratch;
                   for (std::size_t first = begin; first < end; first += kCellLanes) {
                     const std::size_t count = std::min(kCellLanes, end - first);
                     const Smallest scaled = quality.smallest(
                         {mesh.points.data(), count,
                          [&](std::size_t i) {
                            return mesh.nodes.data() + (first + i) * mesh.nodesPerCell();
                          }},
                         scratch);
                     for (std::size_t i = 0; i < count; ++i) use(first + i, scaled[i], block);
                   }
                 });
}

}  // namespace

std::vector<double> equidistant(int order) {
  std::vector<double> places;
  for (int i = 0; i <= order; ++i) places.push_back(static_cast<double>(i) / order);
  return places;
}

LagrangeColumns::LagrangeColumns(int order, const std::vector<double>& places)
    : value{places.size(), static_cast<std::size_t>(order) + 1, {}}, derivative(value) {
  const auto node = [order](std::size_t i) {
    return static_cast<double>(i) / static_cast<double>(order);
  };
  for (const double place : places) {
    for (std::size_t i = 0; i < value.columns; ++i) {
      double product = 1;
      double sum = 0;
      for (std::size_t j = 0; j < value.columns; ++j) {
        if (j == i) continue;
        product *= (place - node(j)) / (node(i) - node(j));
        double without = 1 / (node(i) - node(j));
        for (std::size_t k = 0; k < value.columns; ++k) {
          if (k != i && k != j) without *= (place - node(k)) / (node(i) - node(k));
        }
        sum += without;
      }
      value.entries.push_back(product);
      derivative.entries.push_back(sum);
    }
  }
}

LagrangeQuality::LagrangeQuality(int order)
    : atNodes_(order, equidistant(order)), atGauss_(order, gaussPoints(order + 1)) {}

std::array<double, kCellLanes> LagrangeQuality::smallest(const LagrangeCells& cells,
                                                         LagrangeScratch& scratch) const {
  Smallest smallest;
  smallest.fill(1);
  static const Lower lowerBy = widestLower();
  lowerBy(atNodes_, cells, scratch, smallest);
  lowerBy(atGauss_, cells, scratch, smallest);
  for (double& scaled : smallest) scaled = std::max(scaled, -1.0);
  return smallest;
}

}  // namespace hexhex::curved

namespace hexhex {

Array<double> scaledJacobians(const LagrangeMesh& mesh, Context& context) {
  mesh::requireConsistent(mesh);
  return inStage(context, "scaledJacobians", "quality", [&](Stage& stage) {
    Array<double> result(mesh.cellCount());
    withThreads(context.threads(), [&] {
      curved::forCells(mesh, stage, [&](std::size_t cell, double scaled, std::size_t /*block*/) {
        result[cell] = scaled;
      });
    });
    return result;
  });
}

Certificate certify(const LagrangeMesh& mesh, Context& context) {
  mesh::requireConsistent(mesh);
  Certificate certificate;
  const std::size_t n = mesh.cellCount();
  if (n == 0) return certificate;
  inStage(context, "certify", "quality", [&](Stage& stage) {
    certificate.scaledJacobians.resize(n);
    certificate.validity.resize(n);
    const mesh::CellValidity cells(mesh.order);
    withThreads(context.threads(), [&] {
      std::vector<mesh::BlockFindings> blocks(blockCount(n, curved::kLagrangeQualityGrain));
      std::vector<std::vector<Vec3>> nodesOfBlock(blocks.size());
      curved::forCells(mesh, stage, [&](std::size_t cell, double scaled, std::size_t block) {
        curved::nodesOf(mesh, cell, nodesOfBlock[block]);
        const CellCertificate known = cells.examine(nodesOfBlock[block]);
        certificate.scaledJacobians[cell] = scaled;
        certificate.validity[cell] = known.validity;
        blocks[block].add(cell, scaled, known);
      });
      mesh::BlockFindings::finish(
          blocks, cells,
          [&](std::uint64_t cell, std::vector<Vec3>& nodes) { curved::nodesOf(mesh, cell, nodes); },
          stage, certificate);
    });
    certificate.quality = summarize(certificate.scaledJacobians);
  });
  return certificate;
}

HexMesh straightMesh(const LagrangeMesh& mesh) {
  mesh::requireConsistent(mesh);
  HexMesh straight;
  straight.features = mesh.features;
  straight.regions = mesh.regions;
  const auto vertices = static_cast<std::ptrdiff_t>(mesh.vertexCount);
  straight.points.assign(mesh.points.begin(), mesh.points.begin() + vertices);
  if (!mesh.generatorCorners.empty()) {  // files from other programs have none
    straight.generatorTet.assign(mesh.generatorTet.begin(), mesh.generatorTet.begin() + vertices);
    straight.generatorCorners.assign(mesh.generatorCorners.begin(),
                                     mesh.generatorCorners.begin() + vertices);
  }
  straight.cells.resize(mesh.cellCount());
  const std::size_t perCell = mesh.nodesPerCell();
  for (std::size_t c = 0; c < straight.cells.size(); ++c) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      straight.cells[c][corner] =
          mesh.nodes[c * perCell + curved::nodeOfCorner(corner, mesh.order)];
    }
  }
  return straight;
}

}  // namespace hexhex
