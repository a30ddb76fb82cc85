// How much Lagrange cells are distorted.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <hexhex/curved.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <curved/lagrange.hpp>
#include <mesh/lagrange_check.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 64;

/// Values and derivatives of the Lagrange polynomials of an order at some places in [0, 1].
struct Basis {
  std::size_t nodes;  ///< order + 1
  std::size_t places;
  std::vector<double> value;       ///< of polynomial i at place q: [q * nodes + i]
  std::vector<double> derivative;  ///< likewise

  Basis(int order, const std::vector<double>& at)
      : nodes(static_cast<std::size_t>(order) + 1),
        places(at.size()),
        value(nodes * at.size()),
        derivative(nodes * at.size()) {
    const auto node = [order](std::size_t i) {
      return static_cast<double>(i) / static_cast<double>(order);
    };
    for (std::size_t q = 0; q < places; ++q) {
      for (std::size_t i = 0; i < nodes; ++i) {
        double product = 1;
        double sum = 0;
        for (std::size_t j = 0; j < nodes; ++j) {
          if (j == i) continue;
          product *= (at[q] - node(j)) / (node(i) - node(j));
          double without = 1 / (node(i) - node(j));
          for (std::size_t k = 0; k < nodes; ++k) {
            if (k != i && k != j) without *= (at[q] - node(k)) / (node(i) - node(k));
          }
          sum += without;
        }
        value[q * nodes + i] = product;
        derivative[q * nodes + i] = sum;
      }
    }
  }
};

std::vector<double> equidistant(int order) {
  std::vector<double> places;
  for (int i = 0; i <= order; ++i) places.push_back(static_cast<double>(i) / order);
  return places;
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

/// Evaluates cells of one order at one grid of places.
class Evaluator {
 public:
  explicit Evaluator(const Basis& basis) : basis_(basis) {}

  /// The smallest scaled determinant.
  [[nodiscard]] double smallest(const std::vector<Vec3>& nodes) {
    const std::vector<double>* const v = &basis_.value;
    const std::vector<double>* const d = &basis_.derivative;
    contract(nodes, {d, v, v}, columns_[0]);
    contract(nodes, {v, d, v}, columns_[1]);
    contract(nodes, {v, v, d}, columns_[2]);
    double smallest = 1;
    for (std::size_t q = 0; q < columns_[0].size(); ++q) {
      const Vec3& a = columns_[0][q];
      const Vec3& b = columns_[1][q];
      const Vec3& c = columns_[2][q];
      const double scaled = tripleProduct(a, b, c) / (length(a) * length(b) * length(c));
      smallest = std::min(smallest, std::isfinite(scaled) ? scaled : 0.0);
    }
    return std::clamp(smallest, -1.0, 1.0);
  }

 private:
  /// Replaces nodes by places, one axis after the other.
  void contract(const std::vector<Vec3>& nodes,
                const std::array<const std::vector<double>*, 3>& matrices,
                std::vector<Vec3>& result) {
    std::array<std::size_t, 3> size = {basis_.nodes, basis_.nodes, basis_.nodes};
    result = nodes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<std::size_t, 3> newSize = size;
      newSize[axis] = basis_.places;
      scratch_.assign(newSize[0] * newSize[1] * newSize[2], Vec3{});
      const std::size_t stride = axis == 0 ? 1 : (axis == 1 ? size[0] : size[0] * size[1]);
      const std::size_t outer = size[0] * size[1] * size[2] / (stride * size[axis]);
      const std::vector<double>& matrix = *matrices[axis];
      for (std::size_t o = 0; o < outer; ++o) {
        for (std::size_t q = 0; q < basis_.places; ++q) {
          for (std::size_t i = 0; i < basis_.nodes; ++i) {
            const double factor = matrix[q * basis_.nodes + i];
            for (std::size_t s = 0; s < stride; ++s) {
              const Vec3& from = result[s + stride * (i + size[axis] * o)];
              Vec3& to = scratch_[s + stride * (q + basis_.places * o)];
              for (std::size_t k = 0; k < 3; ++k) to[k] += factor * from[k];
            }
          }
        }
      }
      result.swap(scratch_);
      size = newSize;
    }
  }

  const Basis& basis_;
  std::array<std::vector<Vec3>, 3> columns_;
  std::vector<Vec3> scratch_;
};

}  // namespace

Array<double> scaledJacobians(const LagrangeMesh& mesh, Context& context) {
  requireConsistent(mesh);
  Stage stage(context, "quality");
  const Basis atNodes(mesh.order, equidistant(mesh.order));
  const Basis atGauss(mesh.order, gaussPoints(mesh.order + 1));
  const std::size_t perCell = mesh.nodesPerCell();
  Array<double> result(mesh.cellCount());
  withThreads(context.threads(), [&] {
    parallelBlocks(stage, result.size(), kGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                     Evaluator nodes(atNodes);
                     Evaluator gauss(atGauss);
                     std::vector<Vec3> points(perCell);
                     for (std::size_t c = begin; c < end; ++c) {
                       for (std::size_t i = 0; i < perCell; ++i) {
                         points[i] = mesh.points[mesh.nodes[c * perCell + i]];
                       }
                       result[c] = std::min(nodes.smallest(points), gauss.smallest(points));
                     }
                   });
  });
  return result;
}

HexMesh straightMesh(const LagrangeMesh& mesh) {
  requireConsistent(mesh);
  HexMesh straight;
  straight.features = mesh.features;
  straight.regions = mesh.regions;
  const auto vertices = static_cast<std::ptrdiff_t>(mesh.vertexCount);
  straight.points.assign(mesh.points.begin(), mesh.points.begin() + vertices);
  if (!mesh.generatorCorners.empty()) {  // files of others have none
    straight.generatorTet.assign(mesh.generatorTet.begin(), mesh.generatorTet.begin() + vertices);
    straight.generatorCorners.assign(mesh.generatorCorners.begin(),
                                     mesh.generatorCorners.begin() + vertices);
  }
  straight.cells.resize(mesh.cellCount());
  const std::size_t perCell = mesh.nodesPerCell();
  for (std::size_t c = 0; c < straight.cells.size(); ++c) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      straight.cells[c][corner] = mesh.nodes[c * perCell + nodeOfCorner(corner, mesh.order)];
    }
  }
  return straight;
}

}  // namespace hexhex
