#include <algorithm>
#include <bit>
#include <cmath>

#include <atlas/cell_walker.hpp>
#include <sweep/cell_seeds.hpp>

#include <base/vector3.hpp>

namespace hexhex {

namespace {

using Vector = std::array<double, 3>;

/// Errors of plane values, as a multiple of the longest edge, the largest coordinate of a corner,
/// and the largest coordinate of a corner or of the point. With u = 2^-53, the edge e, and the
/// coordinates r: coordinates err by u r when they are rounded, components of edges by 3 u r, of
/// normals by 16 u e r, of the vector to the point by 3 u r; the product of the normal (at most
/// 2 e^2 in each component, e being at most 2 r) and that vector (at most 2 r) errs by less than
/// 200 u e r^2.
constexpr double kPlaneError = 0x1p-45;

/// Half the diagonals' products with a vector, by corner.
std::array<double, 8> halfDiagonals(const Vector& v) {
  const double plus = 0.5 * (v[0] + v[1]);
  const double minus = 0.5 * (v[0] - v[1]);
  const double z = 0.5 * v[2];
  return {-plus - z, minus - z, plus - z, -minus - z, -plus + z, minus + z, plus + z, -minus + z};
}

CellCornerSet isNegative(double x) {
  return static_cast<CellCornerSet>(std::bit_cast<std::uint64_t>(x) >> 63);
}

double largest(const Vector& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

}  // namespace

void CellWalker::enter(Index tet) {
  const int shift = std::countr_zero(static_cast<std::uint64_t>(map_.exact.unit));
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = static_cast<std::int32_t>(map_.exact.corners[tet][0][k] >> shift);
  }
  nodes_.resize(1);
  Node& first = nodes_.front();
  first.stop = {tet, charts_.chart[tet] != Charts::kNoChart, {}};
  first.fromTet = {};
  first.entered = -1;
  for (int i = 0; i < 4; ++i) first.corners[static_cast<std::size_t>(i)] = relative(first, i);
  measure(first);
}

CellWalker::Vector CellWalker::relative(const Node& node, int corner) const noexcept {
  const std::int64_t unit = map_.exact.unit;
  const LatticePoint& there = map_.exact.corners[node.stop.tet][static_cast<std::size_t>(corner)];
  const LatticePoint here = node.fromTet.isIdentity() ? there : node.fromTet(there, unit);
  const double scale = 1.0 / static_cast<double>(unit);
  Vector r;
  for (std::size_t k = 0; k < 3; ++k) {
    r[k] = static_cast<double>(here[k] - origin_[k] * unit) * scale;
  }
  return r;
}

/// Fills in all that follows from the corners.
void CellWalker::measure(Node& node) noexcept {
  node.next.fill(kUnknown);
  double edge = 0;
  node.reach = largest(node.corners[0]);
  for (std::size_t i = 1; i < 4; ++i) {
    node.reach = std::max(node.reach, largest(node.corners[i]));
    edge = std::max(edge, largest(minus(node.corners[i], node.corners[0])));
  }
  // Other edges are at most twice as long.
  node.error = kPlaneError * 2 * edge * node.reach;
  for (std::size_t f = 0; f < 4; ++f) {
    if (static_cast<int>(f) == node.entered) continue;
    const Vector& p = node.corners[static_cast<std::size_t>(kFaceCorners[f][0])];
    node.normals[f] = cross(minus(node.corners[static_cast<std::size_t>(kFaceCorners[f][1])], p),
                            minus(node.corners[static_cast<std::size_t>(kFaceCorners[f][2])], p));
  }
}

CellWalker::Sides CellWalker::look(const Node& node, const GridPoint& z,
                                   CellCornerSet corners) const {
  Vector center;
  for (std::size_t k = 0; k < 3; ++k) center[k] = static_cast<double>(z[k] - origin_[k]) + 0.5;
  Sides sides;
  sides.error = node.error * std::max(node.reach, largest(center) + 0.5);
  for (std::size_t f = 0; f < 4; ++f) {
    if (static_cast<int>(f) == node.entered) continue;  // all come from there
    const Vector& p = node.corners[static_cast<std::size_t>(kFaceCorners[f][0])];
    const Vector& n = node.normals[f];
    sides.center[f] = dot(n, minus(center, p));
    const double extent = 0.5 * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]));
    if (sides.center[f] - extent > 2 * sides.error) continue;
    const std::array<double, 8> half = halfDiagonals(n);
    CellCornerSet notInside = 0;
    CellCornerSet outside = 0;
    for (CellCornerSet rest = corners; rest != 0; rest &= rest - 1) {
      const auto c = static_cast<std::size_t>(std::countr_zero(rest));
      // Without branches, which nobody could predict.
      notInside |= isNegative(sides.center[f] + half[c] - sides.error) << c;
      outside |= isNegative(sides.center[f] + half[c] + sides.error) << c;
    }
    const CellCornerSet unsure = notInside & ~outside;
    if (unsure != 0) outside |= signsOfUnsure(node, static_cast<int>(f), z, unsure);
    sides.outside[f] = outside;
  }
  return sides;
}

/// Which of the corners lie outside of a face, by exact arithmetic in the tet's own chart.
CellCornerSet CellWalker::signsOfUnsure(const Node& node, int face, const GridPoint& z,
                                        CellCornerSet unsure) const {
  const LatticeTet& tet = map_.exact.corners[node.stop.tet];
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  CellCornerSet outside = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    if (((unsure >> c) & 1U) == 0) continue;
    GridPoint corner = z;
    for (std::size_t k = 0; k < 3; ++k) corner[k] += kCellCorners[c][k];
    corner = node.stop.toTet(corner);
    LatticePoint at{};
    for (std::size_t k = 0; k < 3; ++k) at[k] = corner[k] * map_.exact.unit;
    if (orientation(tet[static_cast<std::size_t>(f[0])], tet[static_cast<std::size_t>(f[1])],
                    tet[static_cast<std::size_t>(f[2])], at) < 0) {
      outside |= CellCornerSet{1} << c;
    }
  }
  return outside;
}

/// Sends the corners that are not in the tet into its neighbours.
/// @return those that cannot be sent
CellCornerSet CellWalker::leave(const Group& group, const Sides& sides) {
  CellCornerSet once = 0;
  CellCornerSet twice = 0;
  for (const CellCornerSet outside : sides.outside) {
    twice |= once & outside;
    once |= outside;
  }
  std::array<CellCornerSet, 4> through{};
  for (std::size_t f = 0; f < 4; ++f) through[f] = sides.outside[f] & ~twice;
  CellCornerSet missed = 0;
  for (std::size_t c = 0; twice >> c != 0; ++c) {
    const CellCornerSet corner = CellCornerSet{1} << c;
    if ((twice & corner) == 0) continue;
    const int face = firstExit(nodes_[group.node], sides, c);
    (face < 0 ? missed : through[static_cast<std::size_t>(face)]) |= corner;
  }
  // Ways that turn about an edge come to an end sooner than this.
  constexpr std::size_t kMaxNodes = 10000;
  for (int face = 0; face < 4; ++face) {
    const CellCornerSet corners = through[static_cast<std::size_t>(face)];
    if (corners == 0) continue;
    const HalfFace halfFace = halfFaceOf(nodes_[group.node].stop.tet, face);
    if (map_.topology.isBoundary(halfFace) || nodes_.size() >= kMaxNodes) {
      missed |= corners;
    } else {
      front_.push_back({behind(group.node, face), corners});
    }
  }
  return missed;
}

/// The face through which the way to a corner outside of several faces leaves; -1 if that is not
/// certain.
int CellWalker::firstExit(const Node& node, const Sides& sides, std::size_t corner) {
  // The plane of face f is reached at the fraction center / (center - value) of the way.
  int first = -1;
  double firstCenter = 0;
  double firstDepth = 0;
  for (std::size_t f = 0; f < 4; ++f) {
    if (((sides.outside[f] >> corner) & 1U) == 0) continue;
    const double center = sides.center[f];
    const double depth = -(center + halfDiagonals(node.normals[f])[corner]);
    if (!(center > sides.error) || !(depth > sides.error)) return -1;
    if (first >= 0) {
      const double later = center * firstDepth - firstCenter * depth;
      const double error = 2 * sides.error * (center + depth + firstCenter + firstDepth);
      if (std::abs(later) <= error) return -1;
      if (later > 0) continue;
    }
    first = static_cast<int>(f);
    firstCenter = center;
    firstDepth = depth;
  }
  return first;
}

/// The node behind a face, which is not on the boundary.
std::uint32_t CellWalker::behind(std::uint32_t node, int face) {
  const auto f = static_cast<std::size_t>(face);
  if (nodes_[node].next[f] != kUnknown) return nodes_[node].next[f];
  const auto added = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node& from = nodes_[node];
  Node& to = nodes_.back();
  from.next[f] = added;
  const TetTopology& topology = map_.topology;
  const Transitions& transitions = map_.exact.transitions;
  const HalfFace halfFace = halfFaceOf(from.stop.tet, face);
  const HalfFace mate = topology.mate[halfFace];
  to.stop = from.stop;
  to.stop.tet = tetOf(mate);
  to.fromTet = from.fromTet;
  to.entered = localOf(mate);
  if (from.stop.inSight) to.stop.inSight = charts_.isGlued(topology, transitions, halfFace);
  if (transitions.isJump(halfFace)) {
    to.stop.toTet = transitions.across(halfFace) * from.stop.toTet;
    to.fromTet = from.fromTet * transitions.across(mate);
  }
  const Tet& tet = topology.tets[to.stop.tet];
  for (int i = 0; i < 4; ++i) {
    const auto corner = static_cast<std::size_t>(i);
    to.corners[corner] = i == to.entered ? relative(to, i)
                                         : from.corners[static_cast<std::size_t>(
                                               topology.localCorner(from.stop.tet, tet[corner]))];
  }
  measure(to);
  return added;
}

}  // namespace hexhex
