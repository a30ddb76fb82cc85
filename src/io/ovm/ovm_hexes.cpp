// From a polyhedral mesh to hexahedra (see ovm_cells.hpp).
#include <algorithm>
#include <atomic>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/prefetch.hpp>
#include <base/vector3.hpp>
#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_topology.hpp>

namespace hexhex {
namespace {

/// Where a value stands in a loop, or 4.
std::size_t placeIn(const std::array<Index, 4>& loop, Index vertex) {
  return static_cast<std::size_t>(std::find(loop.begin(), loop.end(), vertex) - loop.begin());
}

/// Where side i of the base begins in the loop of a face that passes it in the other direction; or
/// 4, also if the face shares more with the base.
std::size_t sideOfBase(const std::array<Index, 4>& base, const std::array<Index, 4>& loop) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t place = placeIn(loop, base[(i + 1) % 4]);
    if (place < 4 && loop[(place + 1) % 4] == base[i]) return i;
  }
  return 4;
}

/// A loop from a vertex of it on; from anywhere if it has no such vertex.
std::array<Index, 4> beginningAt(const std::array<Index, 4>& loop, Index vertex) {
  const std::size_t start =
      (loop[1] == vertex ? 1U : 0U) + (loop[2] == vertex ? 2U : 0U) + (loop[3] == vertex ? 3U : 0U);
  return {loop[start % 4], loop[(start + 1) % 4], loop[(start + 2) % 4], loop[(start + 3) % 4]};
}

/// The hexahedron if half-faces come in the order of kOvmHexFaces, as they do in most files.
bool assembleListed(const std::array<std::array<Index, 4>, 6>& loops, Hex& hex) {
  const std::array<Index, 4>& base = loops[0];
  const std::array<Index, 4> front = beginningAt(loops[2], base[0]);
  const std::array<Index, 4> back = beginningAt(loops[3], base[3]);
  hex = {base[0], base[1], base[2], base[3], front[1], front[2], back[2], back[3]};
  for (std::size_t s = 1; s < 6; ++s) {
    const auto& corners = kOvmHexFaces[s];
    const std::array<Index, 4> loop = beginningAt(loops[s], hex[corners[0]]);
    for (std::size_t i = 0; i < 4; ++i) {
      if (loop[i] != hex[corners[i]]) return false;
    }
  }
  return !hasVertexTwice(hex);
}

class HexReader {
 public:
  HexReader(OvmMesh&& mesh, const std::string& fileName, Stage& stage)
      : file_(std::move(mesh)),
        topology_(file_.topology),
        properties_(file_.properties),
        fileName_(fileName),
        stage_(stage),
        loops_(topology_, stage) {}

  HexMesh read();

 private:
  void readCells();
  [[nodiscard]] bool readCell(std::size_t cell);
  void turnIfInsideOut();
  void readGenerators();
  void readFeatures();

  OvmMesh file_;
  const OvmTopology& topology_;
  const OvmProperties& properties_;
  const std::string& fileName_;
  Stage& stage_;
  OvmLoops<4> loops_;
  HexMesh mesh_;
};

HexMesh HexReader::read() {
  requireProperCells(topology_, loops_, 6, fileName_, "hexahedra", stage_);
  mesh_.points = std::move(file_.points);
  readCells();
  if (properties_[OvmInteger::CornerOrder].empty()) turnIfInsideOut();
  readGenerators();
  readFeatures();
  return std::move(mesh_);
}

bool HexReader::readCell(std::size_t cell) {
  // Faces of a cell may be far from each other in memory.
  constexpr std::size_t kAhead = 12;
  if (cell + kAhead < mesh_.cells.size()) {
    for (const Index halfFace : topology_.cells[cell + kAhead]) {
      prefetch(&loops_.ofFace(halfFace / 2));
    }
  }
  std::array<std::array<Index, 4>, 6> loops;
  for (std::size_t s = 0; s < 6; ++s) loops[s] = loops_.ofHalfFace(topology_.cells[cell][s]);
  if (!assembleHex(loops, mesh_.cells[cell])) return false;
  const Array<std::int32_t>& orders = properties_[OvmInteger::CornerOrder];
  if (orders.empty()) return true;
  if (orders[cell] < 0 || static_cast<std::size_t>(orders[cell]) >= kHexOrders) return false;
  mesh_.cells[cell] = inHexOrder(mesh_.cells[cell], static_cast<std::size_t>(orders[cell]));
  return true;
}

void HexReader::readCells() {
  mesh_.cells.resize(topology_.cells.size());
  const std::size_t fault =
      firstFault(stage_, mesh_.cells.size(), [this](std::size_t cell) { return readCell(cell); });
  if (fault == mesh_.cells.size()) return;
  throw Error(ErrorCode::FileSyntax,
              fileName_ + ": the half-faces of cell " + std::to_string(fault) +
                  " do not bound a hexahedron, or its corner order is not from 0 to 7.",
              Place{PlaceKind::Cell, fault});
}

void HexReader::turnIfInsideOut() {
  if (!isMostlyNegative(mesh_.points, mesh_.cells, stage_)) return;
  constexpr std::size_t kGrain = 4096;
  constexpr std::size_t kReversed = 4;
  parallelFor(stage_, mesh_.cells.size(), kGrain,
              [this](std::size_t c) { mesh_.cells[c] = inHexOrder(mesh_.cells[c], kReversed); });
}

/// Restores generators that this library wrote. Those of other programs name entities of a tet mesh
/// that is not here.
void HexReader::readGenerators() {
  const Array<std::int32_t>& tets = properties_[OvmInteger::GeneratorTet];
  const Array<std::int32_t>& corners = properties_[OvmInteger::GeneratorCorners];
  if (tets.empty() || corners.empty()) return;
  mesh_.generatorTet.resize(tets.size());
  mesh_.generatorCorners.resize(tets.size());
  const std::size_t fault = firstFault(stage_, tets.size(), [&](std::size_t v) {
    mesh_.generatorTet[v] = static_cast<Index>(tets[v]);
    mesh_.generatorCorners[v] = static_cast<CornerSet>(corners[v]);
    return tets[v] >= -1 && corners[v] >= 1 && corners[v] <= 15;
  });
  if (fault == tets.size()) return;
  throw Error(ErrorCode::FileSyntax,
              fileName_ + ": the generator of vertex " + std::to_string(fault) + " is tet " +
                  std::to_string(tets[fault]) + " with the corner set " +
                  std::to_string(corners[fault]) + ", which must be from 1 to 15.",
              Place{PlaceKind::Vertex, fault});
}

void HexReader::readFeatures() {
  const auto forEachTag = [this](OvmInteger property, const auto& add) {
    const Array<std::int32_t>& tags = properties_[property];
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (tags[i] != 0) add(i, tags[i]);
    }
  };
  forEachTag(OvmInteger::FeatureVertices, [this](std::size_t v, std::int32_t tag) {
    mesh_.features.vertices.push_back({static_cast<Index>(v), tag});
  });
  std::vector<FeatureEdge>& edges = mesh_.features.edges;
  forEachTag(OvmInteger::FeatureEdges, [&](std::size_t e, std::int32_t tag) {
    const auto& [a, b] = topology_.edges[e];
    edges.push_back({{std::min(a, b), std::max(a, b)}, tag});
  });
  std::sort(edges.begin(), edges.end(),
            [](const FeatureEdge& a, const FeatureEdge& b) { return a.vertices < b.vertices; });
  forEachTag(OvmInteger::FeatureFaces, [this](std::size_t f, std::int32_t tag) {
    if (!loops_.isGood(f)) {
      throw Error(ErrorCode::FileSyntax,
                  fileName_ + ": face " + std::to_string(f) +
                      " is tagged as a feature, but is no closed loop of 4 half-edges.");
    }
    mesh_.features.quads.push_back({loops_.ofFace(f), tag});
  });
  const Array<std::int32_t>& regions = properties_[OvmInteger::Region];
  mesh_.regions.assign(regions.begin(), regions.end());
}

}  // namespace

bool assembleHex(const std::array<std::array<Index, 4>, 6>& loops, Hex& hex) noexcept {
  if (assembleListed(loops, hex)) return true;
  const std::array<Index, 4>& base = loops[0];
  std::array<Index, 4> top = {kNone, kNone, kNone, kNone};
  const auto join = [&top](std::size_t i, Index vertex) {
    if (top[i] == kNone) top[i] = vertex;
    return top[i] == vertex;
  };
  unsigned sides = 0;
  std::size_t lid = 0;
  for (std::size_t s = 1; s < 6; ++s) {
    const std::size_t side = sideOfBase(base, loops[s]);
    if (side == 4) {
      lid = s;
      continue;
    }
    // The loop is base[side + 1], base[side], and the two vertices above them.
    const std::size_t place = placeIn(loops[s], base[side]);
    const bool same = join(side, loops[s][(place + 1) % 4]);
    if (!join((side + 1) % 4, loops[s][(place + 2) % 4]) || !same) return false;
    sides |= 1U << side;
  }
  if (sides != 15U || lid == 0) return false;
  hex = {base[0], base[1], base[2], base[3], top[0], top[1], top[2], top[3]};
  if (hasVertexTwice(hex)) return false;
  // The lid passes the vertices above the base in the other direction.
  const std::size_t start = placeIn(loops[lid], top[3]);
  if (start == 4) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    if (loops[lid][(start + i) % 4] != top[3 - i]) return false;
  }
  return true;
}

Hex inHexOrder(const Hex& assembled, std::size_t order) noexcept {
  Hex hex;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t corner = order < 4 ? (order + i) % 4 : (order - i) % 4;
    hex[i] = assembled[corner];
    hex[i + 4] = assembled[corner + 4];
  }
  return hex;
}

bool isMostlyNegative(std::span<const Vec3> points, std::span<const Hex> cells, Stage& stage) {
  const auto sumOf = [&](const Hex& hex, const std::array<std::size_t, 4>& plus_,
                         const std::array<std::size_t, 4>& minus_) {
    Vec3 sum{};
    for (std::size_t i = 0; i < 4; ++i) {
      sum = plus(sum, minus(points[hex[plus_[i]]], points[hex[minus_[i]]]));
    }
    return sum;
  };
  std::atomic<std::int64_t> balance{0};
  constexpr std::size_t kGrain = 4096;
  // Of many cells, some tell: positions are far from each other in memory.
  constexpr std::size_t kAsked = std::size_t{1} << 16;
  const std::size_t step = cells.size() / kAsked + 1;
  parallelBlocks(stage, blockCount(cells.size(), step), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   std::int64_t local = 0;
                   for (std::size_t c = begin * step; c < end * step && c < cells.size();
                        c += step) {
                     const Vec3 x = sumOf(cells[c], {1, 2, 5, 6}, {0, 3, 4, 7});
                     const Vec3 y = sumOf(cells[c], {3, 2, 7, 6}, {0, 1, 4, 5});
                     const Vec3 z = sumOf(cells[c], {4, 5, 6, 7}, {0, 1, 2, 3});
                     const double determinant = tripleProduct(z, x, y);
                     local += determinant > 0 ? 1 : (determinant < 0 ? -1 : 0);
                   }
                   balance.fetch_add(local, std::memory_order_relaxed);
                 });
  return balance.load() < 0;
}

HexMesh toHexMesh(OvmMesh&& mesh, const std::string& fileName, Stage& stage) {
  return HexReader(std::move(mesh), fileName, stage).read();
}

}  // namespace hexhex
