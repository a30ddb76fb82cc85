#include <algorithm>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <curved/lagrange.hpp>
#include <improve/curved_cells.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kCurvedCellsGrain = 1024;

/// Of the determinant: its degree along each axis, and one.
constexpr int placesOf(int order) { return 3 * order; }

}  // namespace

CurvedCells::CurvedCells(const LagrangeMesh& mesh)
    : mesh_(mesh),
      columns_(mesh.order, curved::equidistant(placesOf(mesh.order) - 1)),
      toBezier_(mesh::nodeMatrices<double>(columns_.value.rows - 1).values),
      quality_(mesh.order),
      validity_(mesh.order) {}

std::span<const Index> CurvedCells::nodesOf(std::size_t cell) const {
  return std::span(mesh_.nodes).subspan(cell * mesh_.nodesPerCell(), mesh_.nodesPerCell());
}

CellPoints CurvedCells::points(const adjacency::VertexCells& around) const {
  return {mesh_.nodes, mesh_.nodesPerCell(), around, mesh_.points.size()};
}

adjacency::VertexCells CurvedCells::cellsAroundNodes(Stage& stage) const {
  return adjacency::VertexCells(mesh_.points.size(), stage, [&](const auto& add) {
    parallelFor(stage, mesh_.cellCount(), kCurvedCellsGrain, [&](std::size_t c) {
      for (const Index node : nodesOf(c)) add(node, static_cast<Index>(c));
    });
  });
}

Hex CurvedCells::cornersOf(std::size_t cell) const {
  Hex corners{};
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = nodesOf(cell)[curved::nodeOfCorner(i, mesh_.order)];
  return corners;
}

void CurvedCells::take(const Array<Vec3>& points, std::size_t cell, Scratch& scratch) const {
  scratch.nodes.clear();
  for (const Index node : nodesOf(cell)) scratch.nodes.push_back(points[node]);
}

CellState CurvedCells::stateOf(const Array<Vec3>& points, std::size_t cell, double least,
                               Scratch& scratch) const {
  take(points, cell, scratch);
  const double scaled = quality_.smallest(scratch.nodes, scratch.values);
  if (scaled <= 0 || scaled < least) return {scaled, false};
  return {scaled, hasPositiveCoefficients(scratch) ||
                      validity_.examine(scratch.nodes).validity == Validity::Positive};
}

bool CurvedCells::hasPositiveCoefficients(Scratch& scratch) const {
  constexpr double kSafe = 1e-9;  // far more than rounding makes of sums of some hundred terms
  columns_.evaluate(scratch.nodes, scratch.values);
  mesh::Bezier<double>& determinants = scratch.determinants;
  determinants.size.fill(toBezier_.columns);
  determinants.values.clear();
  const auto& [u, v, w] = scratch.values.columns;
  for (std::size_t i = 0; i < u.values.size(); ++i) {
    determinants.values.push_back(tripleProduct(u.values[i], v.values[i], w.values[i]));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mesh::apply(toBezier_, axis, determinants, scratch.numbers);
  }
  const auto [lowest, highest] =
      std::minmax_element(determinants.values.begin(), determinants.values.end());
  return *lowest > kSafe * *highest;
}

void CurvedCells::addTerms(const Array<Vec3>& points, std::size_t cell, Index moving,
                           const IdealBox& box, bool bezier, Scratch& scratch,
                           std::vector<EnergyTerm>& terms) const {
  take(points, cell, scratch);
  columns_.evaluate(scratch.nodes, scratch.values);
  const std::span<const Index> nodes = nodesOf(cell);
  const auto node =
      static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), moving) - nodes.begin());
  const std::size_t n = columns_.value.columns;
  const std::size_t m = columns_.value.rows;
  const std::array<std::size_t, 3> place = {node % n, node / n % n, node / n / n};
  scratch.terms.clear();
  for (std::size_t at = 0; at < m * m * m; ++at) {
    const std::array<std::size_t, 3> row = {at % m, at / m % m, at / m / m};
    std::array<Vec3, 3> edges;
    Vec3 weights;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scale = 1.0 / box[axis];
      edges[axis] = times(scale, scratch.values.columns[axis].values[at]);
      weights[axis] = scale;
      for (std::size_t a = 0; a < 3; ++a) {
        const mesh::Matrix<double>& matrix = a == axis ? columns_.derivative : columns_.value;
        weights[axis] *= matrix.entries[row[a] * n + place[a]];
      }
    }
    scratch.terms.push_back(termOf(edges, weights));
  }
  if (bezier) toBezier(scratch);
  for (const EnergyTerm& term : scratch.terms) {
    if (term.growth > 0 || dot(term.normal, term.normal) > 0) terms.push_back(term);
  }
}

/// From the determinants at places to Bezier coefficients.
void CurvedCells::toBezier(Scratch& scratch) const {
  mesh::Bezier<double>& determinants = scratch.determinants;
  mesh::Bezier<Vec3>& normals = scratch.normals;
  determinants.size.fill(toBezier_.columns);
  normals.size.fill(toBezier_.columns);
  determinants.values.clear();
  normals.values.clear();
  for (const EnergyTerm& term : scratch.terms) {
    determinants.values.push_back(term.determinant);
    normals.values.push_back(term.normal);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mesh::apply(toBezier_, axis, determinants, scratch.numbers);
    mesh::apply(toBezier_, axis, normals, scratch.values.scratch);
  }
  for (std::size_t i = 0; i < scratch.terms.size(); ++i) {
    scratch.terms[i].determinant = determinants.values[i];
    scratch.terms[i].normal = normals.values[i];
  }
}

namespace {

/// Features by their vertices, each of which is found at the cells that have it.
template <std::size_t n, class Feature>
class FeatureFinder {
 public:
  explicit FeatureFinder(const std::vector<Feature>& features) {
    for (const Feature& feature : features) {
      entries_.push_back({sorted(feature.vertices), feature.tag});
    }
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.vertices < b.vertices; });
  }
  [[nodiscard]] bool empty() const { return entries_.empty(); }

  /// The first time that vertices are asked for, the tags of all features between them.
  [[nodiscard]] std::vector<std::int32_t> take(const std::array<Index, n>& vertices) {
    const std::array<Index, n> key = sorted(vertices);
    auto entry = std::lower_bound(
        entries_.begin(), entries_.end(), key,
        [](const Entry& a, const std::array<Index, n>& b) { return a.vertices < b; });
    std::vector<std::int32_t> tags;
    for (; entry != entries_.end() && entry->vertices == key && !entry->isTaken; ++entry) {
      tags.push_back(entry->tag);
      entry->isTaken = true;
    }
    return tags;
  }

 private:
  struct Entry {
    std::array<Index, n> vertices;
    std::int32_t tag;
    bool isTaken = false;
  };
  std::vector<Entry> entries_;
};

/// The nodes of one cell by their places.
class NodeGrid {
 public:
  NodeGrid(const LagrangeMesh& mesh, std::size_t cell)
      : order_(mesh.order), nodes_(mesh.nodes.data() + cell * mesh.nodesPerCell()) {}

  [[nodiscard]] Index at(const lattice::GridPoint& place) const {
    const auto n = order_ + 1;
    return nodes_[place[0] + n * (place[1] + n * place[2])];
  }
  [[nodiscard]] Index corner(std::size_t c) const { return at(between(c, c, 0, c, 0)); }
  /// From corner a so far towards corners b and c.
  [[nodiscard]] lattice::GridPoint between(std::size_t a, std::size_t b, int s, std::size_t c,
                                           int t) const {
    lattice::GridPoint place{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = lattice::kCellCorners[a][k];
      place[k] = order_ * from + s * (lattice::kCellCorners[b][k] - from) +
                 t * (lattice::kCellCorners[c][k] - from);
    }
    return place;
  }

 private:
  int order_;
  const Index* nodes_;
};

void refineFeatures(const LagrangeMesh& mesh, HexFeatures& refined) {
  FeatureFinder<2, FeatureEdge> edges(mesh.features.edges);
  FeatureFinder<4, FeatureQuad> quads(mesh.features.quads);
  refined.vertices = mesh.features.vertices;
  if (edges.empty() && quads.empty()) return;
  for (std::size_t cell = 0; cell < mesh.cellCount(); ++cell) {
    const NodeGrid grid(mesh, cell);
    for (const auto& [a, b] : adjacency::kHexEdges) {
      for (const std::int32_t tag : edges.take({grid.corner(a), grid.corner(b)})) {
        for (int s = 0; s < mesh.order; ++s) {
          refined.edges.push_back(
              {{grid.at(grid.between(a, b, s, a, 0)), grid.at(grid.between(a, b, s + 1, a, 0))},
               tag});
        }
      }
    }
    for (const auto& face : adjacency::kHexFaces) {
      const auto at = [&](int s, int t) {
        return grid.at(grid.between(face[0], face[1], s, face[3], t));
      };
      for (const std::int32_t tag : quads.take(
               {at(0, 0), at(mesh.order, 0), at(mesh.order, mesh.order), at(0, mesh.order)})) {
        for (int i = 0; i < mesh.order * mesh.order; ++i) {
          const int s = i % mesh.order;
          const int t = i / mesh.order;
          refined.quads.push_back({{at(s, t), at(s + 1, t), at(s + 1, t + 1), at(s, t + 1)}, tag});
        }
      }
    }
  }
}

}  // namespace

HexMesh refinedMesh(const LagrangeMesh& mesh, Stage& stage) {
  HexMesh refined;
  refined.points = mesh.points;
  refined.generatorTet = mesh.generatorTet;
  refined.generatorCorners = mesh.generatorCorners;
  refineFeatures(mesh, refined.features);
  const int p = mesh.order;
  const auto width = static_cast<std::size_t>(p);
  const std::size_t parts = width * width * width;
  for (const std::int32_t region : mesh.regions) {
    refined.regions.insert(refined.regions.end(), parts, region);
  }
  refined.cells.resize(parts * mesh.cellCount());
  parallelFor(stage, mesh.cellCount(), kCurvedCellsGrain, [&](std::size_t cell) {
    const NodeGrid grid(mesh, cell);
    for (std::size_t part = 0; part < parts; ++part) {
      const int i = static_cast<int>(part);
      for (std::size_t corner = 0; corner < 8; ++corner) {
        const lattice::GridPoint& offset = lattice::kCellCorners[corner];
        refined.cells[parts * cell + part][corner] =
            grid.at({i % p + offset[0], i / p % p + offset[1], i / p / p + offset[2]});
      }
    }
  });
  return refined;
}

}  // namespace hexhex::improvement
