// Distortion of Lagrange cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <hexhex/curved.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <curved/lagrange.hpp>
#include <curved/lagrange_quality.hpp>
#include <mesh/certificates.hpp>
#include <mesh/lagrange_check.hpp>

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

/// The smallest scaled determinant.
double smallestOf(const LagrangeColumns::Values& values) {
  double smallest = 1;
  for (std::size_t q = 0; q < values.columns[0].values.size(); ++q) {
    const Vec3& a = values.columns[0].values[q];
    const Vec3& b = values.columns[1].values[q];
    const Vec3& c = values.columns[2].values[q];
    const double scaled = tripleProduct(a, b, c) / (length(a) * length(b) * length(c));
    smallest = std::min(smallest, std::isfinite(scaled) ? scaled : 0.0);
  }
  return std::clamp(smallest, -1.0, 1.0);
}

/// Calls use(cell, its nodes, its scaled Jacobian, block) for all cells.
template <class Use>
void forCells(const LagrangeMesh& mesh, Stage& stage, const Use& use) {
  const LagrangeQuality quality(mesh.order);
  parallelBlocks(stage, mesh.cellCount(), kLagrangeQualityGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   LagrangeColumns::Values values;
                   std::vector<Vec3> points;
                   for (std::size_t c = begin; c < end; ++c) {
                     nodesOf(mesh, c, points);
                     use(c, points, quality.smallest(points, values), block);
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

void LagrangeColumns::evaluate(const std::vector<Vec3>& nodes, Values& result) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mesh::Bezier<Vec3>& column = result.columns[axis];
    column.size.fill(value.columns);
    column.values = nodes;
    for (std::size_t a = 0; a < 3; ++a) {
      mesh::apply(a == axis ? derivative : value, a, column, result.scratch);
    }
  }
}

LagrangeQuality::LagrangeQuality(int order)
    : atNodes_(order, equidistant(order)), atGauss_(order, gaussPoints(order + 1)) {}

double LagrangeQuality::smallest(const std::vector<Vec3>& nodes,
                                 LagrangeColumns::Values& values) const {
  atNodes_.evaluate(nodes, values);
  const double least = smallestOf(values);
  atGauss_.evaluate(nodes, values);
  return std::min(least, smallestOf(values));
}

}  // namespace hexhex::curved

namespace hexhex {

Array<double> scaledJacobians(const LagrangeMesh& mesh, Context& context) {
  mesh::requireConsistent(mesh);
  return inStage(context, "scaledJacobians", "quality", [&](Stage& stage) {
    Array<double> result(mesh.cellCount());
    withThreads(context.threads(), [&] {
      curved::forCells(mesh, stage,
                       [&](std::size_t cell, const auto&, double scaled, std::size_t /*block*/) {
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
      curved::forCells(mesh, stage,
                       [&](std::size_t cell, const auto& nodes, double scaled, std::size_t block) {
                         const CellCertificate known = cells.examine(nodes);
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
