#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <quantize/seamless/cut_graph.hpp>
#include <quantize/seamless/integer_form.hpp>
#include <quantize/seamless/seamless_conditions.hpp>
#include <shape/frames_space.hpp>
#include <untangle/foldover_energy.hpp>

#include <base/vector3.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::shape {

namespace {

using adjacency::HalfFace;
using quantization::CutGraph;
using quantization::IntegerForm;
using quantization::VertexConditions;

/// Unknowns are rounded to multiples of this fraction of the map's size.
constexpr double kGrid = 0x1p-40;
/// Parameters, sums of unknowns with rational factors, are multiples of this fraction of the grid.
constexpr double kFraction = 0x1p-6;

Vec3 asArray(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

/// The corners of each tet, in coordinates of its frame.
std::vector<TetParameters> inFrames(const FrameTets& tets) {
  std::vector<TetParameters> parameters(tets.size());
  for (Index t = 0; t < tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      parameters[t][i] = asArray(tets.frames[t].transpose() * tets.point(tets.mesh().tets[t][i]));
    }
  }
  return parameters;
}

/// Expresses the parameters of all sectors by free unknowns.
class SeamlessSpace {
 public:
  SeamlessSpace(const FrameTets& tets, const EdgeWalks& walks, const CutGraph& graph)
      : unknowns_(tets.topology(), walks.fans(), graph, alignmentOf(tets, graph)),
        rows_(3 * graph.sectorCount) {
    const adjacency::TetTopology& topology = tets.topology();
    std::vector<VertexConditions> conditions(topology.pointCount);
    std::vector<IntegerForm> equations = unknowns_.equations();
    for (Index v = 0; v < topology.pointCount; ++v) {
      if (topology.isIsolated(v)) continue;
      conditions[v] = quantization::conditionsOf(v, topology, graph, unknowns_, equations);
    }
    const quantization::IntegerSystem system(unknowns_.size(), std::move(equations));
    shared_ = system.combinations();
    numbers_.assign(unknowns_.size(), -1);
    for (const Index free : system.freeVariables()) numbers_[free] = count_++;
    for (const VertexConditions& vertex : conditions) {
      if (!vertex.sectors.empty()) addVertex(vertex);
    }
  }

  void giveTo(untangle::Problem& problem) const {
    for (const auto& row : rows_) {
      for (const auto& [unknown, factor] : row) {
        if (factor != 0) problem.sums.entries.push_back({unknown, factor});
      }
      problem.sums.begins.push_back(problem.sums.entries.size());
    }
    problem.x.assign(static_cast<std::size_t>(count_), 0.0);
  }

 private:
  /// Boundary triangles lie in planes.
  static quantization::Alignment alignmentOf(const FrameTets& tets, const CutGraph& graph);

  /// Adds a multiple of a form in shared unknowns to a coordinate.
  void add(std::size_t coordinate, const IntegerForm& form, double factor) {
    for (const auto& [variable, coefficient] : form.terms()) {
      for (const auto& [free, share] : shared_[variable]) {
        rows_[coordinate][numbers_[free]] += factor * static_cast<double>(coefficient) * share;
      }
    }
  }

  void addVertex(const VertexConditions& vertex) {
    std::array<int, 3> own{};
    for (std::size_t k = 0; k < 3; ++k) own[k] = vertex.fixed[k].factor == 0 ? count_++ : -1;
    for (const VertexConditions::Sector& sector : vertex.sectors) {
      for (int from = 0; from < 3; ++from) {
        const lattice::Direction to = sector.rotation(lattice::direction(from, 1));
        const auto axis = static_cast<std::size_t>(lattice::axisOf(to));
        const std::size_t coordinate = 3 * std::size_t{sector.sector} + axis;
        const auto k = static_cast<std::size_t>(from);
        add(coordinate, sector.translation[axis], 1);
        if (own[k] >= 0) {
          rows_[coordinate][own[k]] += lattice::signOf(to);
        } else {
          const auto& [factor, rest] = vertex.fixed[k];
          add(coordinate, rest, -lattice::signOf(to) / static_cast<double>(factor));
        }
      }
    }
  }

  quantization::SharedUnknowns unknowns_;
  std::vector<std::vector<std::pair<Index, double>>> shared_;
  std::vector<int> numbers_;  ///< per shared unknown: its number among all if free, else -1
  int count_ = 0;
  std::vector<std::map<int, double>> rows_;  ///< per sector and axis
};

/// The Jacobian of a tet, from space to the common chart.
Eigen::Matrix3d jacobianOf(const untangle::Element& element, const TetParameters& u) {
  Eigen::Matrix3d j = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 edge = minus(u[i + 1], u[0]);
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = 0; column < 3; ++column) {
        j(row, column) += edge[static_cast<std::size_t>(row)] *
                          element.gradients[i][static_cast<std::size_t>(column)];
      }
    }
  }
  return j;
}

untangle::Element elementOf(const FrameTets& tets, const CutGraph& graph, Index t) {
  untangle::Element element;
  const Tet& tet = tets.mesh().tets[t];
  std::array<Vec3, 3> edges{};
  for (std::size_t i = 0; i < 3; ++i)
    edges[i] = asArray(tets.point(tet[i + 1]) - tets.point(tet[0]));
  element.gradients = untangle::tetGradients(edges);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto first = static_cast<int>(3 * graph.sectors[4 * t + i]);
    element.corners[i].unknown = {first, first + 1, first + 2};
    element.corners[i].sign = {1, 1, 1};
  }
  element.weight = tets.volume(t);
  return element;
}

quantization::Alignment SeamlessSpace::alignmentOf(const FrameTets& tets, const CutGraph& graph) {
  quantization::Alignment alignment;
  alignment.axes.assign(tets.topology().mate.size(), quantization::kFree);
  for (HalfFace h = 0; h < alignment.axes.size(); ++h) {
    if (!tets.topology().isBoundary(h)) continue;
    const Index t = adjacency::tetOf(h);
    const Eigen::Vector3d normal =
        jacobianOf(elementOf(tets, graph, t), graph.parameters[t]) * tets.normal(h);
    alignment.axes[h] = static_cast<std::uint8_t>(dominantAxis(asArray(normal)));
  }
  return alignment;
}

}  // namespace

untangle::Problem seamlessProblem(const FrameTets& tets, const EdgeWalks& walks, Stage& stage) {
  const CutGraph graph =
      quantization::cutOpen(tets.topology(), walks.fans(), inFrames(tets), tets.rotations);
  stage.context().throwIfCancelled();
  untangle::Problem problem;
  SeamlessSpace(tets, walks, graph).giveTo(problem);
  double volume = 0;
  for (Index t = 0; t < tets.size(); ++t) {
    untangle::Element& element = problem.elements.emplace_back(elementOf(tets, graph, t));
    volume += element.weight;
    element.target = static_cast<int>(t);
    const Eigen::Matrix3d target = jacobianOf(element, graph.parameters[t]);
    untangle::Matrix3& rows = problem.matrices.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      rows[i] = asArray(target.row(static_cast<Eigen::Index>(i)).transpose());
    }
  }
  for (untangle::Element& element : problem.elements) element.weight /= volume;
  return problem;
}

std::vector<TetParameters> parametersOf(const untangle::Problem& problem) {
  const untangle::Vector x = untangle::coordinatesOf(
      problem, Eigen::Map<const untangle::Vector>(problem.x.data(), std::ssize(problem.x)));
  std::vector<TetParameters> parameters(problem.elements.size());
  for (std::size_t t = 0; t < parameters.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i)
      parameters[t][i] = problem.elements[t].corners[i].at(x.data());
  }
  return parameters;
}

std::vector<Index> roundUnknowns(untangle::Problem& problem) {
  double size = 0;
  for (const double x : problem.x) size = std::max(size, std::abs(x));
  const double grid = std::exp2(std::ceil(std::log2(std::max(size, 1e-300)))) * kGrid;
  for (double& x : problem.x) x = std::nearbyint(x / grid) * grid;
  const std::vector<TetParameters> parameters = parametersOf(problem);
  std::vector<Index> flipped;
  for (Index t = 0; t < parameters.size(); ++t) {
    lattice::LatticeTet u;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        u[i][k] = std::llround(parameters[t][i][k] / (kFraction * grid));
      }
    }
    if (lattice::orientation(u[0], u[1], u[2], u[3]) <= 0) flipped.push_back(t);
  }
  return flipped;
}

}  // namespace hexhex::shape
