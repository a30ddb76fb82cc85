#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include <parts/part_region.hpp>

namespace hexhex::parts {

namespace {

/// Larger faces are cut up: boxes around them would be as large as tets.
constexpr std::int32_t kFacePiece = 12;

using Triangle = std::array<lattice::LatticePoint, 3>;

constexpr std::uint8_t kAllFaces = 0xf;
constexpr std::uint8_t bitOf(adjacency::HalfFace halfFace) {
  return static_cast<std::uint8_t>(1U << halfFace % 4);
}

Triangle triangleOf(const igm::PreparedMap& map, adjacency::HalfFace halfFace) {
  const lattice::LatticeTet& corners = map.exact.corners[adjacency::tetOf(halfFace)];
  const std::array<int, 3>& face = lattice::kFaceCorners[halfFace % 4];
  return {corners[static_cast<std::size_t>(face[0])], corners[static_cast<std::size_t>(face[1])],
          corners[static_cast<std::size_t>(face[2])]};
}

/// Boxes begin and end at multiples of this, so that those of small adjacent faces coincide:
/// otherwise each tet would receive, and compare, as many boxes as there are faces around.
constexpr std::int32_t kBoxRounding = 4;

/// A box of grid points around a triangle, with a margin of at least `reach` on all sides.
lattice::GridBox boxAround(const Triangle& triangle, std::int64_t unit, std::int32_t reach) {
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
  lattice::GridBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({triangle[0][k], triangle[1][k], triangle[2][k]});
    // Shifts round down.
    const std::int32_t first = static_cast<std::int32_t>(low >> shift) - reach;
    const std::int32_t last = static_cast<std::int32_t>(-(-high >> shift)) + reach;
    box.range[k] = {first & ~(kBoxRounding - 1), (last + kBoxRounding - 1) & ~(kBoxRounding - 1)};
  }
  return box;
}

/// Calls visit(triangle) for pieces of a triangle that are no longer than `size` along any axis.
template <class Visit>
void cutUp(const Triangle& triangle, std::int64_t size, const Visit& visit) {
  std::size_t longest = 0;
  std::int64_t most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const lattice::LatticePoint along = triangle[(i + 1) % 3] - triangle[i];
    for (const std::int64_t extent : along) {
      if (std::abs(extent) > most) {
        most = std::abs(extent);
        longest = i;
      }
    }
  }
  if (most <= size) {
    visit(triangle);
    return;
  }
  const lattice::LatticePoint& a = triangle[longest];
  const lattice::LatticePoint& b = triangle[(longest + 1) % 3];
  const lattice::LatticePoint& c = triangle[(longest + 2) % 3];
  lattice::LatticePoint middle;
  for (std::size_t k = 0; k < 3; ++k) middle[k] = a[k] + (b[k] - a[k]) / 2;
  cutUp({a, middle, c}, size, visit);
  cutUp({middle, b, c}, size, visit);
}

/// Whether a triangle may meet a closed box: neither an axis of the grid nor the triangle's normal
/// separates them, with a margin for rounding.
bool mayMeet(const Triangle& triangle, const lattice::GridBox& box, std::int64_t unit) {
  std::array<Vec3, 3> corners;
  Vec3 middle;
  Vec3 half;
  const double grid = 1 / static_cast<double>(unit);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t origin = std::int64_t{box.range[k].first} * unit;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i][k] = static_cast<double>(triangle[i][k] - origin) * grid;
    }
    const auto size = static_cast<double>(std::int64_t{box.range[k].last} - box.range[k].first);
    half[k] = size / 2 + 0.01;  // far above rounding
    middle[k] = size / 2;
    const auto [low, high] = std::minmax({corners[0][k], corners[1][k], corners[2][k]});
    if (low > middle[k] + half[k] || high < middle[k] - half[k]) return false;
  }
  double distance = 0;
  double radius = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    const double normal = (corners[1][i] - corners[0][i]) * (corners[2][j] - corners[0][j]) -
                          (corners[1][j] - corners[0][j]) * (corners[2][i] - corners[0][i]);
    distance += normal * (middle[k] - corners[0][k]);
    radius += std::abs(normal) * half[k];
  }
  return std::abs(distance) <= radius * (1 + 1e-6);
}

lattice::GridBox carried(const lattice::Transition& transition, const lattice::GridBox& box) {
  lattice::GridPoint low;
  lattice::GridPoint high;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = box.range[k].first;
    high[k] = box.range[k].last;
  }
  const lattice::GridPoint a = transition(low);
  const lattice::GridPoint b = transition(high);
  lattice::GridBox image;
  for (std::size_t k = 0; k < 3; ++k) image.range[k] = {std::min(a[k], b[k]), std::max(a[k], b[k])};
  return image;
}

bool contains(const lattice::GridBox& outer, const lattice::GridBox& inner) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (inner.range[k].first < outer.range[k].first || inner.range[k].last > outer.range[k].last) {
      return false;
    }
  }
  return true;
}

}  // namespace

RegionFinder::RegionFinder(const igm::PreparedMap& map, const Partition& partition,
                           std::uint64_t cells)
    : map_(map),
      partition_(partition),
      mostBoxes_(map.topology.tetCount() + cells),
      entryOfTet_(map.topology.tetCount(), kNone) {}

atlas::GridRegion RegionFinder::find(std::uint32_t part, std::uint32_t layers) {
  const std::span<const Index> tets = partition_.tetsOf(part);
  const auto reach = static_cast<std::int32_t>(layers);
  assert(entries_.empty() && queue_.empty());
  enterWhole(tets);
  for (const Index tet : tets) {
    if (const TetBlocks* const blocks = partition_.blocksOf(tet)) {
      startAtBlocks(*blocks, part, reach);
    } else {
      startAtFaces(tet, reach + 1);
    }
  }
  std::size_t head = 0;
  while (head < queue_.size()) {  // grows meanwhile
    if (queue_.size() > mostBoxes_) {
      enterAll();
      break;
    }
    const Reached at = queue_[head++];
    cross(at.tet, entries_[entryOfTet_[at.tet]].boxes[at.box]);
  }
  queue_.clear();
  for (const Entry& entry : entries_) entryOfTet_[entry.tet] = kNone;
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.tet < b.tet; });
  atlas::GridRegion region;
  for (const Entry& entry : entries_) {
    region.tets.push_back(entry.tet);
    region.begin.push_back(region.boxes.size());
    region.boxes.insert(region.boxes.end(), entry.boxes.begin(), entry.boxes.end());
    region.faces.push_back(entry.whole ? kAllFaces : entry.faces);
  }
  region.begin.push_back(region.boxes.size());
  entries_.clear();
  return region;
}

void RegionFinder::enterWhole(std::span<const Index> tets) {
  for (const Index tet : tets) {
    if (partition_.blocksOf(tet) == nullptr) entryOf(tet).whole = true;
  }
}

/// Starts where a path may leave a tet of the part. Cells that cross the tet reach one unit beyond
/// it.
void RegionFinder::startAtFaces(Index tet, std::int32_t reach) {
  const std::int64_t unit = map_.exact.unit;
  for (int face = 0; face < 4; ++face) {
    const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, face);
    const adjacency::HalfFace mate = map_.topology.mate[halfFace];
    if (mate == kNone) continue;
    const Index entry = entryOfTet_[adjacency::tetOf(mate)];
    if (entry != kNone && entries_[entry].whole) continue;
    cutUp(triangleOf(map_, halfFace), kFacePiece * unit,
          [&](const Triangle& piece) { through(halfFace, boxAround(piece, unit, reach)); });
  }
}

void RegionFinder::startAtBlocks(const TetBlocks& blocks, std::uint32_t part, std::int32_t reach) {
  const auto isOwn = [&](std::size_t b) { return partition_.ofBlock[blocks.first + b] == part; };
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    if (!isOwn(b)) continue;
    const lattice::GridPoint low = blocks.lowOf(b);
    std::int32_t length = blocks.side;
    for (; (b + 1) % blocks.size[2] != 0 && isOwn(b + 1); ++b) length += blocks.side;
    lattice::GridBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.range[k] = {low[k] - reach, low[k] + (k == 2 ? length : blocks.side) + reach};
    }
    this->reach(blocks.tet, box);
  }
}

/// Adds a box to a tet unless another box contains it.
void RegionFinder::reach(Index tet, const lattice::GridBox& box) {
  Entry& entry = entryOf(tet);
  if (entry.whole) return;
  if (std::any_of(entry.boxes.begin(), entry.boxes.end(),
                  [&](const lattice::GridBox& known) { return contains(known, box); })) {
    return;
  }
  queue_.push_back({tet, entry.boxes.size()});
  entry.boxes.push_back(box);
}

void RegionFinder::cross(Index tet, const lattice::GridBox& box) {
  const lattice::GridBox from = box;  // a copy: its array may grow
  for (int face = 0; face < 4; ++face) {
    const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, face);
    const adjacency::HalfFace mate = map_.topology.mate[halfFace];
    if (mate == kNone || !mayMeet(triangleOf(map_, halfFace), from, map_.exact.unit)) continue;
    through(halfFace, from);
  }
}

/// Carries a box that may meet an inner face to the tet behind it.
void RegionFinder::through(adjacency::HalfFace halfFace, const lattice::GridBox& box) {
  const adjacency::HalfFace mate = map_.topology.mate[halfFace];
  assert(mate != kNone);
  entryOf(adjacency::tetOf(halfFace)).faces |= bitOf(halfFace);
  entryOf(adjacency::tetOf(mate)).faces |= bitOf(mate);
  reach(adjacency::tetOf(mate), carried(map_.exact.transitions.across(halfFace), box));
}

/// Enters all tets, with boxes around those that are not the part's.
void RegionFinder::enterAll() {
  for (std::size_t t = 0; t < map_.topology.tetCount(); ++t) {
    const auto tet = static_cast<Index>(t);
    Entry& entry = entryOf(tet);
    if (entry.whole) continue;
    lattice::GridBox box = lattice::gridBox(map_.exact.corners[t], map_.exact.unit);
    for (auto& range : box.range) range = {range.first - 1, range.last + 1};
    entry.boxes.assign(1, box);
    entry.faces = kAllFaces;
  }
}

RegionFinder::Entry& RegionFinder::entryOf(Index tet) {
  if (entryOfTet_[tet] == kNone) {
    entryOfTet_[tet] = static_cast<Index>(entries_.size());
    entries_.push_back({tet, false, 0, {}});
  }
  return entries_[entryOfTet_[tet]];
}

}  // namespace hexhex::parts
