#include <algorithm>

#include <quantize/complex/wall_mesh.hpp>

namespace hexhex::quantization {

namespace {

/// A tet must keep this fraction of its volume when a corner is moved.
constexpr double kLeastShare = 0.2;

/// The point between two others where a coordinate has a given value; its other coordinates are
/// rounded.
lattice::LatticePoint pointBetween(const lattice::LatticePoint& a, const lattice::LatticePoint& b,
                                   std::size_t axis, std::int64_t value) {
  const lattice::Int128 whole = static_cast<lattice::Int128>(b[axis]) - a[axis];
  const lattice::Int128 share = static_cast<lattice::Int128>(value) - a[axis];
  lattice::LatticePoint u;
  for (std::size_t k = 0; k < 3; ++k) {
    const lattice::Int128 product = (static_cast<lattice::Int128>(b[k]) - a[k]) * share;
    // Rounded to nearest, symmetrically, so that constant coordinates remain unchanged.
    const lattice::Int128 doubled = 2 * product;
    const bool isNegative = (doubled < 0) != (whole < 0);
    const lattice::Int128 numerator = doubled < 0 ? -doubled : doubled;
    const lattice::Int128 denominator = whole < 0 ? -whole : whole;
    const auto rounded = static_cast<std::int64_t>((numerator + denominator) / (2 * denominator));
    u[k] = a[k] + (isNegative ? -rounded : rounded);
  }
  return u;
}

}  // namespace

WallMesh::WallMesh(const SeamlessMap& map)
    : MutableTets({map.topology.tets.begin(), map.topology.tets.end()}, map.topology.mate,
                  map.topology.pointCount),
      corners(map.corners),
      change(map.changes),
      isWall(mate.size()),
      isFeature(mate.size()),
      isHeld(map.topology.pointCount),
      original(tets.size()),
      originalFace(mate.size()),
      originalVertices_(static_cast<Index>(map.topology.pointCount)),
      moved_(tets.size(), kNone) {
  for (Index t = 0; t < tets.size(); ++t) original[t] = t;
  for (adjacency::HalfFace h = 0; h < mate.size(); ++h) {
    originalFace[h] = static_cast<std::uint8_t>(h % 4);
    isWall[h] = mate[h] == kNone;
  }
  for (const adjacency::HalfFace h : map.featureFaces) isFeature[h] = isFeature[mate[h]] = true;
  for (const FeatureVertex& feature : map.input.view.features.vertices) {
    featureVertices.insert(feature.vertex);
  }
}

void WallMesh::shrink() {
  MutableTets::shrink();
  moved_.clear();
  moved_.shrink_to_fit();
  corners.shrink_to_fit();
  original.shrink_to_fit();
  originalFace.shrink_to_fit();
  change.shrink();
}

void WallMesh::keepEdge(Index v, Index w) {
  featureEdges.insert(tetmap::pairOf(v, w));
  isHeld[v] = isHeld[w] = true;
}

Index WallMesh::split(const adjacency::TetEdge& at, std::size_t axis, std::int64_t value) {
  const Index v = tets[at.tet][at.corner0];
  const Index w = tets[at.tet][at.corner1];
  std::vector<adjacency::TetEdge> around = {at};
  std::vector<lattice::LatticePoint> middles = {
      pointBetween(corners[at.tet][at.corner0], corners[at.tet][at.corner1], axis, value)};
  adjacency::visitAroundEdge(
      *this, at.tet, at.mask(), middles[0],
      [&](const lattice::LatticePoint& u, adjacency::HalfFace out) { return change[out](u); },
      [&](const auto& turn, const lattice::LatticePoint& u) {
        around.push_back(edge(turn.tet(), v, w));
        middles.push_back(u);
        return true;
      });
  const std::vector<tetmap::Cut> cuts = splitEdge(around);
  const auto middle = static_cast<Index>(vertexCount() - 1);
  const bool isOnFeature = featureEdges.erase(tetmap::pairOf(v, w)) != 0;
  isHeld.push_back(isOnFeature);
  if (isOnFeature) featureEdges.insert({tetmap::pairOf(v, middle), tetmap::pairOf(w, middle)});
  for (std::size_t i = 0; i < cuts.size(); ++i) carryCut(cuts[i], middles[i]);
  return middle;
}

void WallMesh::carryCut(const tetmap::Cut& cut, const lattice::LatticePoint& middle) {
  tetmap::carryCorners(cut, middle, corners);
  tetmap::carryTet(cut, original);
  moved_.push_back(kNone);
  for (adjacency::HalfFace h = 4 * cut.first; h < 4 * cut.first + 4; ++h) change.appendCopyOf(h);
  change.set(4 * cut.first + static_cast<Index>(cut.a), {});
  change.set(4 * cut.second + static_cast<Index>(cut.b), {});
  tetmap::carryFaces(cut, false, isWall);
  tetmap::carryFaces(cut, false, isFeature);
  tetmap::carryFaces(cut, kInside, originalFace);
  requirePositive(cut.first);
  requirePositive(cut.second);
}

void WallMesh::requirePositive(Index tet) const {
  const lattice::LatticeTet& u = corners[tet];
  if (lattice::orientation(u[0], u[1], u[2], u[3]) > 0) return;
  throw TooThinForWalls(
      ErrorCode::FlippedTet,
      "A tet is too thin in the map to be cut by a wall of its motorcycle complex. Make tets "
      "of the map thicker, by moving vertices in it.",
      {PlaceKind::Tet, original[tet]});
}

bool WallMesh::leavesKeptEdge(const MovedCorner& moved) const {
  const Tet& tet = tets[moved.tet];
  if (!isHeld[tet[moved.corner]]) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == moved.corner || !featureEdges.contains(tetmap::pairOf(tet[i], tet[moved.corner])))
      continue;
    for (std::size_t k = 0; k < 3; ++k) {
      // An axis-aligned edge has one coordinate that differs.
      const bool isAlong = at(moved.tet, i)[k] != at(moved.tet, moved.corner)[k];
      if (moved.by[k] != 0 && !isAlong) return true;
    }
  }
  return false;
}

bool WallMesh::mayMove(const MovedCorner& moved) const {
  if (leavesKeptEdge(moved)) return false;
  lattice::LatticeTet u = corners[moved.tet];
  const lattice::Int192 before = lattice::orientationDeterminant(u[0], u[1], u[2], u[3]);
  u[moved.corner] = u[moved.corner] + moved.by;
  const lattice::Int192 after = lattice::orientationDeterminant(u[0], u[1], u[2], u[3]);
  if (after.toDouble() < kLeastShare * before.toDouble()) return false;
  for (int face = 0; face < 4; ++face) {
    if (face == moved.corner || !isWall[adjacency::halfFaceOf(moved.tet, face)]) continue;
    // Moves within the plane of a wall are allowed.
    const auto& c = lattice::kFaceCorners[static_cast<std::size_t>(face)];
    const auto corner = [&](std::size_t k) { return u[static_cast<std::size_t>(c[k])]; };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const lattice::LatticePoint& old = at(moved.tet, moved.corner);
      const auto isOn = [&](std::size_t k) {
        return static_cast<int>(moved.corner) == c[k] || corner(k)[axis] == old[axis];
      };
      if (isOn(0) && isOn(1) && isOn(2) && moved.by[axis] != 0) return false;
    }
  }
  return true;
}

bool WallMesh::moveInto(Index tet, std::uint8_t corner, std::size_t axis, std::int64_t value) {
  std::vector<MovedCorner> star = {{tet, corner, {}}};
  star[0].by[axis] = value - at(tet, corner)[axis];
  moved_[tet] = 0;
  bool isPossible = true;
  for (std::size_t next = 0; next < star.size() && isPossible; ++next) {
    const MovedCorner here = star[next];
    isPossible = mayMove(here);
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(here.tet, face);
      if (face == here.corner || mate[h] == kNone) continue;
      const Index there = adjacency::tetOf(mate[h]);
      const lattice::LatticePoint by = change[h].rotation(here.by);
      if (moved_[there] == kNone) {
        moved_[there] = static_cast<Index>(star.size());
        star.push_back({there, cornerOf(there, tets[here.tet][here.corner]), by});
      } else if (star[moved_[there]].by != by) {
        isPossible = false;  // around a singular curve, the vertex would leave its line
      }
    }
  }
  for (const MovedCorner& each : star) {
    moved_[each.tet] = kNone;
    if (isPossible) corners[each.tet][each.corner] = at(each.tet, each.corner) + each.by;
  }
  return isPossible;
}

}  // namespace hexhex::quantization
