#include <algorithm>

#include <quantize/complex/wall_mesh.hpp>

namespace hexhex::quantization {

namespace {

/// A tet may be left with so much of its volume when a corner is moved.
constexpr double kLeastShare = 0.2;

/// Between two points, where a coordinate has a value; the others rounded.
lattice::LatticePoint pointBetween(const lattice::LatticePoint& a, const lattice::LatticePoint& b,
                                   std::size_t axis, std::int64_t value) {
  const lattice::Int128 whole = static_cast<lattice::Int128>(b[axis]) - a[axis];
  const lattice::Int128 share = static_cast<lattice::Int128>(value) - a[axis];
  lattice::LatticePoint u;
  for (std::size_t k = 0; k < 3; ++k) {
    const lattice::Int128 product = (static_cast<lattice::Int128>(b[k]) - a[k]) * share;
    // Rounded to the nearest, symmetrically, so that constant coordinates stay as they are.
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
    : tets(map.topology.tets.begin(), map.topology.tets.end()),
      corners(map.corners),
      mate(map.topology.mate.begin(), map.topology.mate.end()),
      change(map.changes),
      isWall(mate.size()),
      isFeature(mate.size()),
      isHeld(map.topology.pointCount),
      original(tets.size()),
      originalFace(mate.size()),
      originalVertices_(static_cast<Index>(map.topology.pointCount)),
      moved_(tets.size(), kNone),
      firstPart_(tets.size(), kNone) {
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
  const auto toSize = [](auto&... lists) { (lists.shrink_to_fit(), ...); };
  parts_.clear();
  firstPart_.clear();
  moved_.clear();
  toSize(parts_, firstPart_, moved_, tets, corners, mate, original, originalFace);
  change.shrink();
}

void WallMesh::keepEdge(Index v, Index w) {
  featureEdges.insert(pairOf(v, w));
  isHeld[v] = isHeld[w] = true;
}

void WallTurn::step() noexcept {
  const adjacency::HalfFace in = mesh_.mate[out()];
  const Tet& from = mesh_.tets[edge_.tet];
  const Index last = from[ahead()];
  const Index tet = adjacency::tetOf(in);
  edge_ = {tet, mesh_.cornerOf(tet, from[edge_.corner0]), mesh_.cornerOf(tet, from[edge_.corner1])};
  face_ = mesh_.cornerOf(tet, last);
}

std::vector<WallMesh::Around> WallMesh::tetsAround(const TetEdge& edge,
                                                   const lattice::LatticePoint& u) const {
  std::vector<Around> ring = {{edge, u}};
  const auto walk = [&](int face) {
    WallTurn turn(*this, edge, face);
    lattice::LatticePoint here = u;
    while (!turn.isAtBoundary()) {
      here = change[turn.out()](here);
      turn.step();
      if (turn.edge().tet == edge.tet) return true;
      ring.push_back({turn.edge(), here});
    }
    return false;
  };
  int face = 0;
  while (lattice::contains(edge.mask(), face)) ++face;
  if (!walk(face)) walk(adjacency::otherFaceAtEdge(edge.mask(), face));
  return ring;
}

Index WallMesh::split(const TetEdge& edge, std::size_t axis, std::int64_t value) {
  const auto ring = tetsAround(
      edge, pointBetween(at(edge.tet, edge.corner0), at(edge.tet, edge.corner1), axis, value));
  const auto middle = static_cast<Index>(vertexCount());
  const Index v = tets[edge.tet][edge.corner0];
  const Index w = tets[edge.tet][edge.corner1];
  const bool isOnFeature = featureEdges.erase(pairOf(v, w)) != 0;
  isHeld.push_back(isOnFeature);
  if (isOnFeature) featureEdges.insert({pairOf(v, middle), pairOf(w, middle)});
  const auto firstNew = static_cast<Index>(tetCount());
  for (const Around& each : ring) appendCopy(each.edge.tet);
  const auto secondOf = [&](Index tet) {
    std::size_t i = 0;
    while (ring[i].edge.tet != tet) ++i;
    return firstNew + static_cast<Index>(i);
  };
  for (const auto& [at, u] : ring) {
    const Index first = at.tet;
    const Index second = secondOf(first);
    parts_.push_back(
        {second, firstPart_[first], tets[first][at.corner0], tets[first][at.corner1], middle});
    firstPart_[first] = static_cast<Index>(parts_.size() - 1);
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(second, face);
      if (mate[h] == kNone || face == at.corner1) continue;
      // The face beyond the new vertex is the second part's alone; those at the edge are split.
      if (face == at.corner0) {
        mate[mate[h]] = h;
      } else {
        mate[h] =
            adjacency::halfFaceOf(secondOf(adjacency::tetOf(mate[h])), adjacency::localOf(mate[h]));
      }
    }
  }
  for (const auto& [at, u] : ring) {
    const Index second = secondOf(at.tet);
    tets[at.tet][at.corner1] = tets[second][at.corner0] = middle;
    corners[at.tet][at.corner1] = corners[second][at.corner0] = u;
    joinInside(adjacency::halfFaceOf(at.tet, at.corner0),
               adjacency::halfFaceOf(second, at.corner1));
    requirePositive(at.tet);
    requirePositive(second);
  }
  return middle;
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
    if (i == moved.corner || !featureEdges.contains(pairOf(tet[i], tet[moved.corner]))) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      // Along an axis, an edge has one coordinate that differs.
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
    // In the plane of a wall it may move.
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
        isPossible = false;  // around a singular curve, which would leave its line
      }
    }
  }
  for (const MovedCorner& each : star) {
    moved_[each.tet] = kNone;
    if (isPossible) corners[each.tet][each.corner] = at(each.tet, each.corner) + each.by;
  }
  return isPossible;
}

void WallMesh::appendCopy(Index tet) {
  const Tet copy = tets[tet];
  const lattice::LatticeTet corner = corners[tet];
  tets.push_back(copy);
  corners.push_back(corner);
  original.push_back(Index{original[tet]});
  firstPart_.push_back(kNone);
  moved_.push_back(kNone);
  for (adjacency::HalfFace h = 4 * tet; h < 4 * tet + 4; ++h) {
    mate.push_back(adjacency::HalfFace{mate[h]});
    change.appendCopyOf(h);
    isWall.push_back(bool{isWall[h]});
    isFeature.push_back(bool{isFeature[h]});
    originalFace.push_back(std::uint8_t{originalFace[h]});
  }
}

void WallMesh::joinInside(adjacency::HalfFace a, adjacency::HalfFace b) {
  mate[a] = b;
  mate[b] = a;
  for (const adjacency::HalfFace h : {a, b}) {
    change.set(h, {});
    isWall[h] = isFeature[h] = false;
    originalFace[h] = kInside;
  }
}

WallMesh::Found WallMesh::find(Index v, Index w, Index tet) const {
  // The tet itself is the first of its parts; those split off, and their parts, in a tree.
  std::vector<Index> toLookAt = {tet};
  while (!toLookAt.empty()) {
    const Index t = toLookAt.back();
    toLookAt.pop_back();
    const auto has = [&](Index vertex) {
      return std::find(tets[t].begin(), tets[t].end(), vertex) != tets[t].end();
    };
    if (has(v) && has(w)) return {TetEdge{t, cornerOf(t, v), cornerOf(t, w)}, kNone};
    for (Index p = firstPart_[t]; p != kNone; p = parts_[p].next) {
      const Part& part = parts_[p];
      if ((part.kept == v && part.given == w) || (part.kept == w && part.given == v)) {
        return {std::nullopt, part.middle};
      }
      toLookAt.push_back(part.tet);
    }
  }
  throw Error(ErrorCode::Internal, "An edge of a wall has vanished. This is a bug.",
              {PlaceKind::Edge, v, w});
}

}  // namespace hexhex::quantization
