// Numbers and places the vertices of the grid, purely by index arithmetic, without look-ups.
#include <algorithm>

#include <base/vector3.hpp>
#include <samples/tet_grid.hpp>

namespace hexhex::samples {

namespace {

/// Corners of the faces of a sub-block, counter-clockwise from outside.
constexpr std::array<std::array<std::size_t, 4>, 6> kFaceCorners = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

}  // namespace

std::array<SurfaceTriangle, 12> surfaceTriangles(const std::array<Index, 8>& vertices) {
  std::array<SurfaceTriangle, 12> triangles{};
  for (std::size_t face = 0; face < 6; ++face) {
    const std::array<std::size_t, 4>& corners = kFaceCorners[face];
    std::size_t smallest = 0;
    for (std::size_t c = 1; c < 4; ++c) {
      if (vertices[corners[c]] < vertices[corners[smallest]]) smallest = c;
    }
    const std::size_t first = corners[smallest];
    const std::size_t opposite = corners[(smallest + 2) % 4];
    triangles[2 * face] = {first, corners[(smallest + 1) % 4], opposite};
    triangles[2 * face + 1] = {first, opposite, corners[(smallest + 3) % 4]};
  }
  return triangles;
}

TetGrid::TetGrid(const BlockModel& model, const BlockComplex& complex, int cells, int refine)
    : cells_(cells), refine_(refine), blockCount_(complex.blockCount()) {
  const auto row = static_cast<Slot>(refine) + 1;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    cornerOffsets_[corner] = (corner & 1) + (corner >> 1 & 1) * row + (corner >> 2 & 1) * row * row;
  }
  numberGridVertices(model, complex);
  placeCentres();
}

Int3 TetGrid::gridPoint(const Occurrence& occurrence, std::size_t dimension,
                        std::size_t point) const {
  Int3 result = {};
  for (std::size_t a = 0; a < 3; ++a) result[a] = (occurrence.origin >> a & 1) == 1 ? refine_ : 0;
  auto rest = static_cast<std::int64_t>(point);
  for (std::size_t a = 0; a < dimension; ++a) {
    const lattice::Direction axis = occurrence.axes[a];
    result[static_cast<std::size_t>(lattice::axisOf(axis))] +=
        lattice::signOf(axis) * (1 + rest % (refine_ - 1));
    rest /= refine_ - 1;
  }
  return result;
}

Slot TetGrid::slot(std::size_t block, const Int3& gridPoint) const {
  const std::int64_t row = refine_ + 1;
  const std::int64_t plane = static_cast<std::int64_t>(block) * row + gridPoint[2];
  return static_cast<Slot>((plane * row + gridPoint[1]) * row + gridPoint[0]);
}

std::size_t TetGrid::subBlock(std::size_t block, const Int3& lowCorner) const {
  const std::int64_t plane = static_cast<std::int64_t>(block) * refine_ + lowCorner[2];
  return static_cast<std::size_t>((plane * refine_ + lowCorner[1]) * refine_ + lowCorner[0]);
}

Slot TetGrid::lowSlot(std::size_t subBlock) const {
  const auto row = static_cast<std::size_t>(refine_);
  const std::size_t block = subBlock / (row * row * row);
  const Int3 low = {static_cast<std::int64_t>(subBlock % row),
                    static_cast<std::int64_t>(subBlock / row % row),
                    static_cast<std::int64_t>(subBlock / (row * row) % row)};
  return slot(block, low);
}

template <class T>
std::array<T, 8> TetGrid::atCorners(const std::vector<T>& perSlot, std::size_t subBlock) const {
  const Slot low = lowSlot(subBlock);
  std::array<T, 8> corners{};
  for (std::size_t c = 0; c < 8; ++c) corners[c] = perSlot[low + cornerOffsets_[c]];
  return corners;
}

std::array<Index, 8> TetGrid::cornerVertices(std::size_t subBlock) const {
  return atCorners(vertices, subBlock);
}

std::array<Int3, 8> TetGrid::cornerParameters(std::size_t subBlock) const {
  return atCorners(parameters, subBlock);
}

std::array<Vec3, 8> TetGrid::cornersInMap(std::size_t subBlock) const {
  const std::array<Int3, 8> own = cornerParameters(subBlock);
  std::array<Vec3, 8> corners{};
  for (std::size_t c = 0; c < 8; ++c) {
    const Int3 difference = own[c] - centreParameters[subBlock];
    for (std::size_t a = 0; a < 3; ++a) corners[c][a] = static_cast<double>(difference[a]);
  }
  return corners;
}

std::array<Vec3, 8> TetGrid::cornersInSpace(std::size_t subBlock) const {
  const Vec3& centre = points[centreVertex(subBlock)];
  const std::array<Index, 8> ids = cornerVertices(subBlock);
  std::array<Vec3, 8> corners{};
  for (std::size_t c = 0; c < 8; ++c) corners[c] = minus(points[ids[c]], centre);
  return corners;
}

/// The parameter of grid line i of a block: cells * i / refine, rounded to units symmetrically
/// (neighbouring blocks count from opposite ends) and exact wherever it is an integer.
std::int64_t TetGrid::gridLine(std::int64_t i) const {
  const std::int64_t length = cells_ * kUnitsPerCell;
  return 2 * i <= refine_ ? i * length / refine_ : length - (refine_ - i) * length / refine_;
}

/// Vertices on a coarse cell are numbered in the frame of the cell, so all blocks around it arrive
/// at the same numbers independently.
void TetGrid::numberGridVertices(const BlockModel& model, const BlockComplex& complex) {
  const auto row = static_cast<std::size_t>(refine_ + 1);
  vertices.resize(blockCount_ * row * row * row);
  parameters.resize(vertices.size());
  for (const CoarseCell& cell : complex.cells()) {
    gridVertexCount_ += innerPointCount(cell.dimension);
  }
  points.reserve(gridVertexCount_ + subBlockCount());
  for (const CoarseCell& cell : complex.cells()) {
    for (std::size_t point = 0; point < innerPointCount(cell.dimension); ++point) {
      const auto vertex = static_cast<Index>(points.size());
      for (const Occurrence& occurrence : cell.occurrences) {
        const Int3 at = gridPoint(occurrence, cell.dimension, point);
        const Slot place = slot(occurrence.block, at);
        vertices[place] = vertex;
        parameters[place] = {gridLine(at[0]), gridLine(at[1]), gridLine(at[2])};
      }
      const Occurrence& first = cell.occurrences.front();
      const Int3 at = gridPoint(first, cell.dimension, point);
      Vec3 local{};
      for (std::size_t a = 0; a < 3; ++a) {
        local[a] = static_cast<double>(at[a]) / static_cast<double>(refine_);
      }
      points.push_back(model.place(first.block, local));
    }
  }
}

/// Centres are means of corners, not images of the centre under the block's shape: those can lie
/// outside a sub-block with the flat faces of a coarse grid.
void TetGrid::placeCentres() {
  centreParameters.resize(subBlockCount());
  for (std::size_t sub = 0; sub < subBlockCount(); ++sub) {
    Int3 parameterSum{};
    for (const Int3& corner : cornerParameters(sub)) parameterSum = parameterSum + corner;
    Vec3 pointSum{};
    for (const Index corner : cornerVertices(sub)) pointSum = plus(pointSum, points[corner]);
    for (std::size_t a = 0; a < 3; ++a) {
      centreParameters[sub][a] = parameterSum[a] / 8;
      pointSum[a] /= 8;
    }
    points.push_back(pointSum);
  }
}

}  // namespace hexhex::samples
