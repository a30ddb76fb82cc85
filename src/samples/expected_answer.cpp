// Counts cells of the coarse complex, whose numbers scale with powers of the cells per block edge,
// and tags its features.
#include <array>
#include <vector>

#include <base/disjoint_sets.hpp>
#include <samples/steps.hpp>

namespace hexhex::samples {

namespace {

/// Components of blocks that share a face.
std::uint64_t countComponents(const BlockComplex& complex) {
  DisjointSets blocks(complex.blockCount());
  for (const CoarseCell& cell : complex.cells()) {
    if (cell.dimension != 2 || cell.boundary) continue;
    blocks.unite(static_cast<Index>(cell.occurrences[0].block),
                 static_cast<Index>(cell.occurrences[1].block));
  }
  return blocks.count();
}

/// Components of boundary faces that share an edge.
std::uint64_t countBoundaryComponents(const BlockComplex& complex) {
  const std::vector<CoarseCell>& cells = complex.cells();
  DisjointSets sets(cells.size());
  for (Index face = 0; face < cells.size(); ++face) {
    if (cells[face].dimension != 2 || !cells[face].boundary) continue;
    for (const std::size_t edge : complex.sides(face)) sets.unite(static_cast<Index>(edge), face);
  }
  std::uint64_t count = 0;
  for (Index cell = 0; cell < cells.size(); ++cell) {
    if (cells[cell].boundary && cells[cell].dimension >= 1 && sets.find(cell) == cell) ++count;
  }
  return count;
}

/// Corners are where nothing can move, curves where something is singular, and patches are the
/// boundary.
bool isOnFeature(const CoarseCell& cell) {
  if (cell.dimension == 0) return !cell.free[0] && !cell.free[1] && !cell.free[2];
  return cell.dimension == 1 ? cell.singular() : cell.dimension == 2 && cell.boundary;
}

/// Per coarse cell: the tag of its class, counted from 1 in each dimension, or 0 if it is on no
/// feature. A curve continues through vertices that are free to move along it, a patch through
/// edges that are free to move in it.
std::vector<std::int32_t> featureTags(const BlockComplex& complex) {
  const std::vector<CoarseCell>& cells = complex.cells();
  DisjointSets classes(cells.size());
  for (Index cell = 0; cell < cells.size(); ++cell) {
    if (!isOnFeature(cells[cell])) continue;
    for (const std::size_t side : complex.sides(cell)) {
      if (!isOnFeature(cells[side])) classes.unite(cell, static_cast<Index>(side));
    }
  }
  std::array<std::int32_t, 3> last{};
  std::vector<std::int32_t> ofClass(cells.size(), 0);
  std::vector<std::int32_t> tags(cells.size(), 0);
  for (Index cell = 0; cell < cells.size(); ++cell) {
    if (!isOnFeature(cells[cell])) continue;
    std::int32_t& tag = ofClass[classes.find(cell)];
    if (tag == 0) tag = ++last[cells[cell].dimension];
    tags[cell] = tag;
  }
  return tags;
}

FeatureAnswer expectedFeatures(const BlockComplex& complex, std::uint64_t cellsPerEdge) {
  const std::vector<std::int32_t> tags = featureTags(complex);
  FeatureAnswer answer;
  answer.regions = complex.blockCount();
  for (std::size_t cell = 0; cell < tags.size(); ++cell) {
    if (tags[cell] == 0) continue;
    const std::size_t dimension = complex.cells()[cell].dimension;
    if (dimension == 0) ++answer.vertices[tags[cell]];
    if (dimension == 1) answer.edges[tags[cell]] += cellsPerEdge;
    if (dimension == 2) answer.quads[tags[cell]] += cellsPerEdge * cellsPerEdge;
  }
  return answer;
}

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
  /// The grid vertex at a number of steps along a coarse edge.
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
  const std::vector<std::int32_t> tags = featureTags(complex);
  FeatureWriter writer(grid, map.features);
  for (std::size_t cell = 0; cell < tags.size(); ++cell) {
    if (tags[cell] == 0) continue;
    const CoarseCell& coarse = complex.cells()[cell];
    const Occurrence& at = coarse.occurrences.front();
    if (coarse.dimension == 0) writer.corner(at, tags[cell]);
    if (coarse.dimension == 1) writer.curve(at, tags[cell]);
    if (coarse.dimension == 2) writer.patch(at, tags[cell]);
  }
  map.regions.reserve(12 * grid.subBlockCount());
  for (std::size_t block = 0; block < grid.blockCount(); ++block) {
    map.regions.insert(map.regions.end(), 12 * grid.subBlocksPerBlock(),
                       static_cast<std::int32_t>(block + 1));
  }
}

SampleAnswer expectedAnswer(const BlockComplex& complex, std::uint64_t cellsPerEdge,
                            bool features) {
  SampleAnswer answer;
  Expectation& expected = answer.expected;
  const auto perEdge = static_cast<std::int64_t>(cellsPerEdge);
  for (const CoarseCell& cell : complex.cells()) {
    answer.vertices += power(perEdge - 1, cell.dimension);
    expected.eulerCharacteristic += cell.dimension % 2 == 0 ? 1 : -1;
    if (cell.dimension == 3) expected.cells += power(perEdge, 3);
    if (cell.dimension == 2 && cell.boundary) expected.boundaryQuads += power(perEdge, 2);
    if (cell.dimension == 1 && cell.singular()) {
      auto& singular = cell.boundary ? expected.boundarySingularEdges : expected.innerSingularEdges;
      singular[cell.valence()] += cellsPerEdge;
    }
  }
  expected.components = countComponents(complex);
  expected.boundaryComponents = countBoundaryComponents(complex);
  if (features) answer.features = expectedFeatures(complex, cellsPerEdge);
  return answer;
}

}  // namespace hexhex::samples
