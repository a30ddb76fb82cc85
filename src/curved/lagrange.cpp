#include <algorithm>
#include <atomic>
#include <string>

#include <curved/lagrange.hpp>
#include <curved/simplex_star.hpp>
#include <sweep/vertex_tables.hpp>

namespace hexhex::curved {

namespace {

constexpr std::size_t kLagrangeGrain = 4096;
constexpr std::size_t kCellGrain = 256;

using Triangle = std::array<lattice::LatticePoint, 3>;

bool separatedByCube(const Triangle& t, std::int64_t unit) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({t[0][k], t[1][k], t[2][k]});
    if (low >= unit || high <= 0) return true;
  }
  return false;
}

/// Separation along the cross product of cube edge k and a triangle edge d.
bool separatedByEdges(const Triangle& t, const lattice::LatticePoint& d, std::size_t k,
                      std::int64_t unit) noexcept {
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  if (d[i] == 0 && d[j] == 0) return false;  // parallel edges have no cross product
  // The function d_i x_j - d_j x_i of a point x.
  const auto at = [&](const lattice::LatticePoint& x) {
    return static_cast<lattice::Int128>(d[i]) * x[j] - static_cast<lattice::Int128>(d[j]) * x[i];
  };
  const auto [low, high] = std::minmax({at(t[0]), at(t[1]), at(t[2])});
  const lattice::Int128 alongJ = static_cast<lattice::Int128>(d[i]) * unit;
  const lattice::Int128 alongI = -static_cast<lattice::Int128>(d[j]) * unit;
  const lattice::Int128 zero = 0;
  const lattice::Int128 cubeLow = std::min(alongI, zero) + std::min(alongJ, zero);
  const lattice::Int128 cubeHigh = std::max(alongI, zero) + std::max(alongJ, zero);
  return low >= cubeHigh || high <= cubeLow;
}

bool separatedByTriangle(const Triangle& t, std::int64_t unit) noexcept {
  const lattice::LatticePoint u = t[1] - t[0];
  const lattice::LatticePoint v = t[2] - t[0];
  // The dot product of the normal and (corner of the cube) - (corner of the triangle): the cube is
  // on one side if its two extreme corners are.
  lattice::Int192 lowest;
  lattice::Int192 highest;
  for (std::size_t k = 0; k < 3; ++k) {
    const lattice::Int128 normal = lattice::crossComponent(u, v, k);
    lowest.addProduct(normal, (normal < 0 ? unit : 0) - t[0][k]);
    highest.addProduct(normal, (normal > 0 ? unit : 0) - t[0][k]);
  }
  return lowest.sign() >= 0 || highest.sign() <= 0;
}

/// A cell, and the tet that owns its centre.
struct CellSeed {
  Index tet;
  lattice::GridPoint z;  ///< smallest corner
};

/// All cells in canonical order.
Array<CellSeed> listCells(const igm::PreparedMap& map, Stage& stage) {
  const sweep::CellCenters centers = sweep::findCells(map, stage);
  Array<CellSeed> cells(centers.count());
  parallelBlocks(stage, map.topology.tetCount(), sweep::kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   std::vector<lattice::SweptLine> scratch;
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     std::uint64_t at = centers.begin[t];
                     sweep::forEachOwnedCenter(
                         map.topology, tet, centers.linesOf(map.exact, tet, scratch),
                         [&](const lattice::SweptLine& line, std::uint32_t i) {
                           cells[at++] = {tet, line.point(i)};
                         });
                   }
                 });
  return cells;
}

/// Collects the nodes of one cell after another. One per thread.
class NodeCollector {
 public:
  /// @param map  scaled for the nodes
  NodeCollector(const igm::PreparedMap& map, const sweep::VertexTables& numbers, int order)
      : map_(map), numbers_(numbers), order_(order) {}

  /// Finds the numbers of the nodes in the refined grid.
  void collect(const CellSeed& cell, std::span<Index> nodes) {
    std::fill(nodes.begin(), nodes.end(), kNone);
    missing_ = nodes.size();
    Frame frame = Frame::along(cell.z, 0);
    for (std::int32_t& coordinate : frame.toChart.translation) coordinate *= order_;
    queue_.assign(1, {cell.tet, lattice::kWholeTet, frame});
    // NOLINTNEXTLINE(modernize-loop-convert): the queue grows meanwhile.
    for (std::size_t head = 0; head < queue_.size(); ++head) {
      const SimplexInTet here = queue_[head];
      take(here, nodes);
      if (missing_ == 0) return;
      addNeighbours(here);
    }
    throw Error(ErrorCode::Internal,
                "A node of a cell was not found. The map passed all checks, so this is a bug; "
                "please report it with the map.",
                {PlaceKind::Tet, cell.tet});
  }

 private:
  /// Takes the nodes in a closed tet.
  void take(const SimplexInTet& here, std::span<Index> nodes) {
    const lattice::LatticeTet seen = here.frame.see(map_.exact.corners[here.tet], map_.exact.unit);
    std::array<lattice::GridRange, 3> range;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({seen[0][k], seen[1][k], seen[2][k], seen[3][k]});
      const auto clamped = [&](std::int64_t x) {
        return static_cast<std::int32_t>(std::clamp<std::int64_t>(x / map_.exact.unit, 0, order_));
      };
      range[k] = {clamped(low), clamped(high)};
    }
    const auto stride = static_cast<std::size_t>(order_) + 1;
    for (std::int32_t k = range[2].first; k <= range[2].last; ++k) {
      for (std::int32_t j = range[1].first; j <= range[1].last; ++j) {
        for (std::int32_t i = range[0].first; i <= range[0].last; ++i) {
          const std::size_t n =
              static_cast<std::size_t>(i) +
              stride * (static_cast<std::size_t>(j) + stride * static_cast<std::size_t>(k));
          if (nodes[n] != kNone) continue;
          nodes[n] =
              numbers_.find(here.tet, here.frame.toChart(lattice::GridPoint{i, j, k})).vertex;
          if (nodes[n] != kNone) --missing_;
        }
      }
    }
  }

  /// Continues through the faces that meet the open cube. The map is injective there, so it does
  /// not matter through which face a tet is reached.
  void addNeighbours(const SimplexInTet& here) {
    const lattice::LatticeTet seen = here.frame.see(map_.exact.corners[here.tet], map_.exact.unit);
    for (int face = 0; face < 4; ++face) {
      if (!cubeMeetsFace(seen, face, order_ * map_.exact.unit)) continue;
      if (map_.topology.isBoundary(adjacency::halfFaceOf(here.tet, face))) continue;
      const SimplexInTet next = crossed(map_.topology, map_.exact, here, face);
      const bool known = std::any_of(queue_.begin(), queue_.end(), [&](const SimplexInTet& other) {
        return other.tet == next.tet && other.frame == next.frame;
      });
      if (!known) queue_.push_back(next);
    }
  }

  const igm::PreparedMap& map_;
  const sweep::VertexTables& numbers_;
  int order_;
  std::size_t missing_ = 0;
  std::vector<SimplexInTet> queue_;
};

/// Renumbers nodes of the refined grid: hex vertices first, the others in the same order.
Array<Index> renumber(const HexMesh& mesh, const LagrangeMesh& result, std::uint64_t count,
                      Stage& stage) {
  Array<Index> number(count);
  parallelFor(stage, count, kLagrangeGrain, [&](std::size_t i) { number[i] = kNone; });
  const std::size_t perCell = result.nodesPerCell();
  std::atomic<bool> contradiction{false};
  parallelFor(stage, mesh.cells.size(), kLagrangeGrain, [&](std::size_t c) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Index node = result.nodes[c * perCell + nodeOfCorner(corner, result.order)];
      const Index before =
          std::atomic_ref(number[node]).exchange(mesh.cells[c][corner], std::memory_order_relaxed);
      if (before != kNone && before != mesh.cells[c][corner]) contradiction = true;
    }
  });
  if (contradiction) {
    throw Error(ErrorCode::Internal,
                "Nodes do not fit the mesh. The map passed all checks, so this is a bug; please "
                "report it with the map.");
  }
  auto next = static_cast<Index>(mesh.points.size());
  for (Index& entry : number) {
    if (entry == kNone) entry = next++;
  }
  return number;
}

/// Positions and generators of all nodes.
void describeNodes(const sweep::VertexTables& numbers, const HexMesh& mesh,
                   const Array<Index>& number, LagrangeMesh& result, Stage& stage) {
  Array<Vec3> points(number.size());
  Array<Index> tets(number.size());
  Array<CornerSet> corners(number.size());
  numbers.describe({points, tets, corners}, stage);
  result.points.resize(number.size());
  result.generatorTet.resize(number.size());
  result.generatorCorners.resize(number.size());
  parallelFor(stage, number.size(), kLagrangeGrain, [&](std::size_t i) {
    const Index n = number[i];
    // Vertices are kept bit for bit: at another scale they would round differently.
    result.points[n] = n < mesh.points.size() ? mesh.points[n] : points[i];
    result.generatorTet[n] = tets[i];
    result.generatorCorners[n] = corners[i];
  });
}

}  // namespace

bool cubeMeetsFace(const lattice::LatticeTet& corners, int face, std::int64_t unit) noexcept {
  Triangle t{};
  for (std::size_t i = 0; i < 3; ++i) {
    t[i] =
        corners[static_cast<std::size_t>(lattice::kFaceCorners[static_cast<std::size_t>(face)][i])];
  }
  if (separatedByCube(t, unit)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const lattice::LatticePoint d = t[(i + 1) % 3] - t[i];
    for (std::size_t k = 0; k < 3; ++k) {
      if (separatedByEdges(t, d, k, unit)) return false;
    }
  }
  return !separatedByTriangle(t, unit);
}

LagrangeMesh groupNodes(const HexMesh& mesh, igm::PreparedMap& map, int order, Context& context) {
  LagrangeMesh result;
  result.order = order;
  result.vertexCount = mesh.points.size();
  Array<CellSeed> cells;
  {
    Stage stage(context, "cell centres");
    cells = listCells(map, stage);
    igm::scaleMap(map.exact, order, stage);
  }
  Stage stage(context, "nodes");
  const sweep::VertexTables numbers(map, stage);
  const std::size_t perCell = result.nodesPerCell();
  result.nodes.resize(cells.size() * perCell);
  parallelBlocks(
      stage, cells.size(), kCellGrain, [&](std::size_t begin, std::size_t end, std::size_t) {
        NodeCollector collector(map, numbers, order);
        for (std::size_t c = begin; c < end; ++c) {
          collector.collect(cells[c], std::span(result.nodes).subspan(c * perCell, perCell));
        }
      });
  const Array<Index> number = renumber(mesh, result, numbers.count(), stage);
  parallelFor(stage, result.nodes.size(), kLagrangeGrain,
              [&](std::size_t i) { result.nodes[i] = number[result.nodes[i]]; });
  describeNodes(numbers, mesh, number, result, stage);
  return result;
}

}  // namespace hexhex::curved
