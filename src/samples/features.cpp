// Every coarse vertex, edge and face on a feature belongs to one class of cells that have the same
// tag: a curve goes on through vertices that are free to move along it, a patch through edges that
// are free to move in it.
#include <algorithm>
#include <numeric>
#include <vector>

#include <samples/features.hpp>

namespace hexhex::samples {

namespace {

/// Per coarse cell: the tag of its class, counted from 1 in each dimension, or 0.
class CoarseTags {
 public:
  explicit CoarseTags(const BlockComplex& complex)
      : complex_(complex), parent_(complex.cells().size()), tags_(parent_.size(), 0) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t cell = 0; cell < parent_.size(); ++cell) {
      const std::size_t dimension = complex.cells()[cell].dimension;
      if (dimension == 0 || dimension == 3 || !onFeature(cell)) continue;
      forEachSide(cell, [&](std::size_t side) {
        if (!onFeature(side)) join(cell, side);
      });
    }
    number();
  }

  [[nodiscard]] std::int32_t operator[](std::size_t cell) const { return tags_[cell]; }

 private:
  /// Corners are where nothing can move, curves where something is singular, patches the boundary.
  [[nodiscard]] bool onFeature(std::size_t index) const {
    const CoarseCell& cell = complex_.cells()[index];
    if (cell.dimension == 0) return !cell.free[0] && !cell.free[1] && !cell.free[2];
    return cell.dimension == 1 ? cell.singular() : cell.boundary;
  }

  /// Cells in the boundary of a cell, with one dimension less.
  template <class Visit>
  void forEachSide(std::size_t index, const Visit& visit) const {
    const CoarseCell& cell = complex_.cells()[index];
    const Occurrence& occurrence = cell.occurrences.front();
    for (std::size_t code = 0; code < BlockPart::kCount; ++code) {
      const BlockPart part = BlockPart::fromCode(code);
      if (part.dimension() + 1 != cell.dimension || !occurrence.part.contains(part)) continue;
      visit(complex_.find(occurrence.block, part).cell);
    }
  }

  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }
  [[nodiscard]] std::size_t root(std::size_t member) const {
    while (parent_[member] != member) member = parent_[member];
    return member;
  }

  void number() {
    std::array<std::int32_t, 4> last{};
    std::vector<std::int32_t> ofRoot(parent_.size(), 0);
    for (std::size_t cell = 0; cell < parent_.size(); ++cell) {
      const std::size_t dimension = complex_.cells()[cell].dimension;
      if (dimension == 3 || !onFeature(cell)) continue;
      std::int32_t& tag = ofRoot[root(cell)];
      if (tag == 0) tag = ++last[dimension];
      tags_[cell] = tag;
    }
  }

  const BlockComplex& complex_;
  std::vector<std::size_t> parent_;
  std::vector<std::int32_t> tags_;
};

/// Writes the tagged tet vertices, edges and faces of coarse cells.
class FeatureWriter {
 public:
  FeatureWriter(const TetGrid& grid, Features& features) : grid_(grid), features_(features) {}

  void corner(const Occurrence& at, std::int32_t tag) {
    features_.vertices.push_back({vertexAlong(at, 0), tag});
  }
  void curve(const Occurrence& at, std::int32_t tag) {
    for (std::int64_t i = 0; i < grid_.refine(); ++i) {
      features_.edges.push_back({{vertexAlong(at, i), vertexAlong(at, i + 1)}, tag});
    }
  }
  void patch(const Occurrence& at, std::int32_t tag) {
    std::size_t axis = 0;
    while (at.part.digits[axis] == BlockPart::kAlong) ++axis;
    const int side = at.part.digits[axis];
    for (std::int64_t i = 0; i < grid_.refine(); ++i) {
      for (std::int64_t j = 0; j < grid_.refine(); ++j) {
        Int3 low{};
        low[axis] = side * (grid_.refine() - 1);
        low[(axis + 1) % 3] = i;
        low[(axis + 2) % 3] = j;
        const std::array<Index, 8> corners = grid_.cornerVertices(grid_.subBlock(at.block, low));
        const std::array<SurfaceTriangle, 12> triangles = surfaceTriangles(corners);
        const std::size_t first = 2 * (2 * axis + static_cast<std::size_t>(side));
        for (const SurfaceTriangle& t : {triangles[first], triangles[first + 1]}) {
          features_.faces.push_back({{corners[t[0]], corners[t[1]], corners[t[2]]}, tag});
        }
      }
    }
  }

 private:
  /// The grid vertex a number of steps along a coarse edge.
  [[nodiscard]] Index vertexAlong(const Occurrence& at, std::int64_t steps) const {
    Int3 point{};
    for (std::size_t a = 0; a < 3; ++a) {
      const int digit = at.part.digits[a];
      point[a] = digit == BlockPart::kAlong ? steps : digit * grid_.refine();
    }
    return grid_.vertices[grid_.slot(at.block, point)];
  }

  const TetGrid& grid_;
  Features& features_;
};

}  // namespace

void addFeatures(const TetGrid& grid, const BlockComplex& complex, TetMap& map) {
  const CoarseTags tags(complex);
  FeatureWriter writer(grid, map.features);
  for (std::size_t cell = 0; cell < complex.cells().size(); ++cell) {
    if (tags[cell] == 0) continue;
    const CoarseCell& coarse = complex.cells()[cell];
    const Occurrence& at = coarse.occurrences.front();
    if (coarse.dimension == 0) writer.corner(at, tags[cell]);
    if (coarse.dimension == 1) writer.curve(at, tags[cell]);
    if (coarse.dimension == 2) writer.patch(at, tags[cell]);
  }
  map.regions.reserve(map.tets.size());
  for (std::size_t block = 0; block < grid.blockCount(); ++block) {
    map.regions.insert(map.regions.end(), 12 * grid.subBlocksPerBlock(),
                       static_cast<std::int32_t>(block + 1));
  }
}

FeatureAnswer expectedFeatures(const BlockComplex& complex, std::uint64_t cellsPerEdge) {
  const CoarseTags tags(complex);
  FeatureAnswer answer;
  for (std::size_t cell = 0; cell < complex.cells().size(); ++cell) {
    const std::size_t dimension = complex.cells()[cell].dimension;
    if (dimension == 3) ++answer.regions;
    if (tags[cell] == 0) continue;
    if (dimension == 0) ++answer.vertices[tags[cell]];
    if (dimension == 1) answer.edges[tags[cell]] += cellsPerEdge;
    if (dimension == 2) answer.quads[tags[cell]] += cellsPerEdge * cellsPerEdge;
  }
  return answer;
}

}  // namespace hexhex::samples
