#include <algorithm>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <curved/lagrange.hpp>
#include <improve/curved_cells.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kCurvedCellsGrain = 1024;

const LagrangeKernels& widestKernels() noexcept {
  static const LagrangeKernels& widest = lagrangeKernels().back();
  return widest;
}

/// @param places  number of equidistant places along each axis
LagrangeGrid gridOf(int order, int places) {
  return {curved::LagrangeColumns(order, curved::equidistant(places - 1))};
}

}  // namespace

CurvedCells::CurvedCells(const LagrangeMesh& mesh, Stage& stage)
    : ImprovedCells(curved::kCellLanes),
      mesh_(mesh),
      around_(mesh.points.size(), stage,
              [&](const auto& add) {
                parallelFor(stage, mesh.cellCount(), kCurvedCellsGrain, [&](std::size_t c) {
                  for (const Index node : nodesOf(c)) add(node, static_cast<Index>(c));
                });
              }),
      grid_(gridOf(mesh.order, 2 * mesh.order)),
      bezierGrid_(gridOf(mesh.order, 3 * mesh.order)),  // one more than the degree
      quality_(mesh.order),
      validity_(mesh.order) {
  bezierGrid_.toBezier = mesh::nodeMatrices<double>(bezierGrid_.columns.value.rows - 1).values;
}

std::span<const Index> CurvedCells::nodesOf(std::size_t cell) const {
  return std::span(mesh_.nodes).subspan(cell * mesh_.nodesPerCell(), mesh_.nodesPerCell());
}

CellPoints CurvedCells::points() const {
  return {mesh_.nodes, mesh_.nodesPerCell(), around_, mesh_.points.size()};
}

Hex CurvedCells::cornersOf(std::size_t cell) const {
  Hex corners{};
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = nodesOf(cell)[curved::nodeOfCorner(i, mesh_.order)];
  return corners;
}

curved::LagrangeCells CurvedCells::lanesOf(const Array<Vec3>& points,
                                           std::span<const Index> cells) const {
  return {points.data(), cells.size(), [&](std::size_t i) { return nodesOf(cells[i]).data(); }};
}

void CurvedCells::measureSome(const Array<Vec3>& points, std::span<const Index> cells,
                              Scratch& scratch, std::span<double> qualities) const {
  constexpr double kSafe = 1e-9;  // far beyond the rounding errors of sums of some hundred terms
  const curved::LagrangeCells lanes = lanesOf(points, cells);
  const auto scaled = quality_.smallest(lanes, scratch.columns);
  const auto shares = widestKernels().leastShares(bezierGrid_, lanes, scratch.columns);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // Not a proof, which takes longer: that follows in the final certificate.
    bool certified = shares[i] > kSafe;
    if (scaled[i] > 0 && !certified) {
      scratch.nodes.clear();
      for (const Index node : nodesOf(cells[i])) scratch.nodes.push_back(points[node]);
      certified = validity_.examine(scratch.nodes).validity == Validity::Positive;
    }
    qualities[i] = scaled[i] > 0 && certified ? scaled[i] : kNotCertified;
  }
}

void CurvedCells::addTerms(const Array<Vec3>& points, std::span<const Index> cells, Index moving,
                           const Array<IdealBox>& boxes, TermKind kind, Scratch& scratch,
                           EnergyTerms& terms) const {
  const LagrangeGrid& grid = kind == TermKind::Bezier ? bezierGrid_ : grid_;
  for (std::size_t first = 0; first < cells.size(); first += curved::kCellLanes) {
    const auto some = cells.subspan(first, std::min(curved::kCellLanes, cells.size() - first));
    MovingNode all{lanesOf(points, some), some.size(), {}, {}};
    for (std::size_t i = 0; i < curved::kCellLanes; ++i) {
      const Index cell = some[std::min(i, some.size() - 1)];
      const std::span<const Index> nodes = nodesOf(cell);
      all.node[i] =
          static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), moving) - nodes.begin());
      for (std::size_t k = 0; k < 3; ++k) all.scale[i][k] = 1.0 / boxes[cell][k];
    }
    widestKernels().terms(grid, all, scratch.columns, terms.add(grid.columns.placeCount()));
  }
}

namespace {

/// Finds features by their vertices.
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

  /// The tags of all features with these vertices, on the first call only.
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

/// The nodes of a cell by their grid coordinates.
class NodeGrid {
 public:
  NodeGrid(const LagrangeMesh& mesh, std::size_t cell)
      : order_(mesh.order), nodes_(mesh.nodes.data() + cell * mesh.nodesPerCell()) {}

  [[nodiscard]] Index at(const lattice::GridPoint& place) const {
    const auto n = order_ + 1;
    return nodes_[place[0] + n * (place[1] + n * place[2])];
  }
  [[nodiscard]] Index corner(std::size_t c) const { return at(between(c, c, 0, c, 0)); }
  /// From corner a, s steps towards corner b and t towards corner c.
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
