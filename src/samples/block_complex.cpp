// Builds the coarse complex: first the cells, then what each of them knows about its surroundings.
#include <algorithm>
#include <map>
#include <utility>

#include <hexhex/error.hpp>

#include <samples/block_complex.hpp>

namespace hexhex::samples {

namespace {

/// The coordinates of a corner of the unit cube.
lattice::GridPoint cornerPoint(std::size_t corner) {
  return {static_cast<int>(corner & 1), static_cast<int>(corner >> 1 & 1),
          static_cast<int>(corner >> 2 & 1)};
}

/// The direction across a face, out of its block.
lattice::Direction outwards(const BlockPart& face) {
  int axis = 0;
  while (face.digits[static_cast<std::size_t>(axis)] == BlockPart::kAlong) ++axis;
  return lattice::direction(axis, face.digits[static_cast<std::size_t>(axis)] == 1 ? 1 : -1);
}

/// The transition across a face, between the frames of two blocks that are unit cubes. Both share
/// the cell's own frame; what points out of one block points into the other.
lattice::Transition transitionAcross(const Occurrence& from, const Occurrence& to) {
  std::array<lattice::Direction, 3> image{};
  const auto send = [&image](lattice::Direction before, lattice::Direction after) {
    image[static_cast<std::size_t>(lattice::axisOf(before))] =
        lattice::signOf(before) < 0 ? lattice::opposite(after) : after;
  };
  send(from.axes[0], to.axes[0]);
  send(from.axes[1], to.axes[1]);
  send(outwards(from.part), lattice::opposite(outwards(to.part)));
  if (lattice::cross(image[0], image[1]) != image[2]) {
    throw Error(ErrorCode::Internal,
                "Two neighbouring blocks of a sample have opposite orientation; please report this "
                "as a bug.");
  }
  return lattice::Transition::taking(cornerPoint(from.origin), cornerPoint(to.origin),
                                     lattice::Rotation::fromAxes(image[0], image[1]));
}

}  // namespace

BlockPart BlockPart::fromCode(std::size_t code) {
  const int digits = static_cast<int>(code);
  return {{digits % 3, digits / 3 % 3, digits / 9}};
}

BlockPart BlockPart::face(std::size_t axis, int side) {
  BlockPart part{{kAlong, kAlong, kAlong}};
  part.digits[axis] = side;
  return part;
}

std::size_t BlockPart::code() const {
  const int code = digits[0] + 3 * digits[1] + 9 * digits[2];
  return static_cast<std::size_t>(code);
}

std::size_t BlockPart::dimension() const {
  return static_cast<std::size_t>(std::count(digits.begin(), digits.end(), kAlong));
}

bool BlockPart::contains(const BlockPart& part) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (digits[a] != kAlong && digits[a] != part.digits[a]) return false;
  }
  return true;
}

std::vector<std::size_t> BlockPart::corners() const {
  std::vector<std::size_t> result;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    if (contains({cornerPoint(corner)})) result.push_back(corner);
  }
  return result;
}

BlockComplex::BlockComplex(std::vector<BlockCorners> blocks) : blocks_(std::move(blocks)) {
  collectCells();
  markBoundary();
  turnStars();
  restrictFreeAxes();
}

/// The occurrence with the frame of its cell: the origin is the corner with the smallest vertex,
/// and the axes are sorted by the vertices to which they lead. For the inside of a block: the
/// block's own frame.
Occurrence BlockComplex::frameOf(std::size_t block, const BlockPart& part) const {
  const BlockCorners& vertices = blocks_[block];
  const std::size_t dimension = part.dimension();
  Occurrence occurrence{block, part, 0, {}, {}};
  if (dimension < 3) {
    const std::vector<std::size_t> corners = part.corners();
    occurrence.origin = *std::min_element(
        corners.begin(), corners.end(),
        [&vertices](std::size_t a, std::size_t b) { return vertices[a] < vertices[b]; });
  }
  std::vector<std::pair<Index, lattice::Direction>> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    if (part.digits[a] != BlockPart::kAlong) continue;
    const std::size_t end = occurrence.origin ^ (std::size_t{1} << a);
    const Index rank = dimension < 3 ? vertices[end] : static_cast<Index>(a);
    axes.emplace_back(rank,
                      lattice::direction(static_cast<int>(a), end > occurrence.origin ? 1 : -1));
  }
  std::sort(axes.begin(), axes.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t a = 0; a < axes.size(); ++a) occurrence.axes[a] = axes[a].second;
  return occurrence;
}

void BlockComplex::collectCells() {
  references_.resize(blocks_.size());
  std::map<std::vector<Index>, std::size_t> cellOfVertices;
  for (std::size_t dimension = 0; dimension <= 3; ++dimension) {
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      for (std::size_t code = 0; code < BlockPart::kCount; ++code) {
        const BlockPart part = BlockPart::fromCode(code);
        if (part.dimension() != dimension) continue;
        std::vector<Index> vertices;
        for (const std::size_t corner : part.corners()) vertices.push_back(blocks_[block][corner]);
        std::sort(vertices.begin(), vertices.end());
        const auto [entry, isNew] = cellOfVertices.try_emplace(vertices, cells_.size());
        if (isNew) cells_.emplace_back().dimension = dimension;
        CoarseCell& cell = cells_[entry->second];
        references_[block][code] = {entry->second, cell.occurrences.size()};
        cell.occurrences.push_back(frameOf(block, part));
      }
    }
  }
}

void BlockComplex::markBoundary() {
  for (const CoarseCell& face : cells_) {
    if (face.dimension != 2 || face.valence() != 1) continue;
    const Occurrence& occurrence = face.occurrences.front();
    for (std::size_t code = 0; code < BlockPart::kCount; ++code) {
      if (!occurrence.part.contains(BlockPart::fromCode(code))) continue;
      cells_[references_[occurrence.block][code].cell].boundary = true;
    }
  }
}

std::vector<std::size_t> BlockComplex::sides(std::size_t cell) const {
  const Occurrence& occurrence = cells_[cell].occurrences.front();
  std::vector<std::size_t> result;
  for (std::size_t code = 0; code < BlockPart::kCount; ++code) {
    const BlockPart part = BlockPart::fromCode(code);
    if (part.dimension() + 1 != cells_[cell].dimension || !occurrence.part.contains(part)) continue;
    result.push_back(find(occurrence.block, part).cell);
  }
  return result;
}

std::optional<Neighbour> BlockComplex::neighbour(std::size_t block, std::size_t axis,
                                                 int side) const {
  const CellReference face = find(block, BlockPart::face(axis, side));
  const std::vector<Occurrence>& sides = cells_[face.cell].occurrences;
  if (sides.size() < 2) return std::nullopt;
  const Occurrence& here = sides[face.occurrence];
  const Occurrence& there = sides[1 - face.occurrence];
  return Neighbour{there.block, transitionAcross(here, there)};
}

/// Carries the frame of the first block around each cell to the others, across faces at the cell.
/// (Around a singular edge the result depends on the path, but only in axes that are not free.)
void BlockComplex::turnStars() {
  for (CoarseCell& cell : cells_) {
    std::vector<std::size_t> reached = {0};
    std::vector<bool> seen(cell.occurrences.size(), false);
    seen[0] = true;
    for (std::size_t next = 0; next < reached.size(); ++next) {
      const Occurrence from = cell.occurrences[reached[next]];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int side = from.part.digits[axis];
        if (side == BlockPart::kAlong) continue;
        const std::optional<Neighbour> other = neighbour(from.block, axis, side);
        if (!other) continue;
        for (std::size_t to = 0; to < cell.occurrences.size(); ++to) {
          if (seen[to] || cell.occurrences[to].block != other->block) continue;
          seen[to] = true;
          cell.occurrences[to].fromFirst = other->transition.rotation * from.fromFirst;
          reached.push_back(to);
        }
      }
    }
  }
}

/// Points of the boundary stay on their integer plane and points of singular edges on their integer
/// line; the same holds for every point where such planes and lines meet.
void BlockComplex::restrictFreeAxes() {
  for (CoarseCell& cell : cells_) {
    for (const Occurrence& occurrence : cell.occurrences) {
      const lattice::Rotation toFirst = occurrence.fromFirst.inverse();
      for (std::size_t code = 0; code < BlockPart::kCount; ++code) {
        const BlockPart around = BlockPart::fromCode(code);
        if (!around.contains(occurrence.part)) continue;
        const CoarseCell& other = cells_[references_[occurrence.block][code].cell];
        const bool fixing =
            (other.dimension == 2 && other.boundary) || (other.dimension == 1 && other.singular());
        if (!fixing) continue;
        for (std::size_t a = 0; a < 3; ++a) {
          if (around.digits[a] == BlockPart::kAlong) continue;
          const lattice::Direction fixed = toFirst(lattice::direction(static_cast<int>(a), 1));
          cell.free[static_cast<std::size_t>(lattice::axisOf(fixed))] = false;
        }
      }
    }
  }
}

}  // namespace hexhex::samples
