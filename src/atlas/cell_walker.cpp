#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <atlas/cell_walker.hpp>
#include <base/vector3.hpp>
#include <sweep/cell_seeds.hpp>

namespace hexhex {

namespace {

using Vector = std::array<double, 3>;

/// Errors of plane values, as a multiple of the longest edge, the largest coordinate of a corner,
/// and the largest coordinate of a corner or of the point. With u = 2^-53, the edge e, and these
/// coordinates R and r: corners err by u R when they are rounded, components of edges by 3 u R, of
/// normals by 16 u e R or, if they are the sum of three, by 60 u e R, and centres are exact. The
/// normal (at most 2 e^2 in each component, e being at most 2 R) times a vector of at most 2 r from
/// corner to point errs by 360 u e R r for the normal and by 12 u e R r for the corner; roundings
/// of the three sums of products (offset, centre, half a diagonal) add at most 48 u e R r each.
/// 1024 u is nearly twice as much as all that.
constexpr double kPlaneError = 0x1p-43;

/// Tets whose faces are remembered.
constexpr std::size_t kRemembered = 256;

/// Ways that turn about an edge come to an end sooner than after so many tets.
constexpr std::size_t kMaxSteps = 10000;

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

CellWalker::CellWalker(const PreparedMap& map, const Charts& charts)
    : map_(map),
      charts_(charts),
      scale_(1.0 / static_cast<double>(map.exact.unit)),
      tetAt_(kRemembered, kNone),
      faces_(kRemembered) {}

void CellWalker::begin(Index tet, const GridPoint& z, CellCornerSet corners) {
  Group group{{tet, charts_.chart[tet] != Charts::kNoChart, {}}, 0, corners, {}};
  for (std::size_t k = 0; k < 3; ++k) group.center[k] = 2 * std::int64_t{z[k]} + 1;
  front_.assign(1, group);
  stepsLeft_ = kMaxSteps;
}

const CellWalker::Faces& CellWalker::facesOf(Index tet) noexcept {
  const std::size_t place = tet % kRemembered;
  if (tetAt_[place] != tet) {
    tetAt_[place] = tet;
    measure(tet, faces_[place]);
  }
  return faces_[place];
}

void CellWalker::measure(Index tet, Faces& faces) const noexcept {
  const LatticeTet& lattice = map_.exact.corners[tet];
  const int shift = std::countr_zero(static_cast<std::uint64_t>(map_.exact.unit));
  std::array<Vector, 4> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t origin = lattice[0][k] >> shift;
    faces.origin[k] = static_cast<double>(origin);
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i][k] = static_cast<double>(lattice[i][k] - (origin << shift)) * scale_;
    }
  }
  // Gradients of the weights of corners 1 to 3 and, as all weights add up to one, of corner 0.
  const std::array<Vector, 3> e = {minus(corners[1], corners[0]), minus(corners[2], corners[0]),
                                   minus(corners[3], corners[0])};
  std::array<Vector, 4> normals = {
      {{}, hexhex::cross(e[1], e[2]), hexhex::cross(e[2], e[0]), hexhex::cross(e[0], e[1])}};
  for (std::size_t k = 0; k < 3; ++k) {
    normals[0][k] = -(normals[1][k] + normals[2][k] + normals[3][k]);
  }
  const double edge = std::max({largest(e[0]), largest(e[1]), largest(e[2])});
  faces.reach = 1 + edge;  // corner 0 is less than 1 from the origin in each axis
  // Other edges are at most twice as long.
  faces.error = kPlaneError * 2 * edge * faces.reach;
  for (std::size_t f = 0; f < 4; ++f) {
    const bool boundary = map_.topology.isBoundary(halfFaceOf(tet, static_cast<int>(f)));
    const Vector n = boundary ? Vector{} : normals[f];
    for (std::size_t k = 0; k < 3; ++k) faces.normal[k][f] = n[k];
    faces.offset[f] =
        boundary ? std::numeric_limits<double>::infinity() : -dot(n, corners[f == 0 ? 1 : 0]);
    faces.extent[f] = 0.5 * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]));
  }
}

CellWalker::Sides CellWalker::look(const Faces& faces, const Group& group,
                                   const GridPoint& z) const {
  Vector center;
  for (std::size_t k = 0; k < 3; ++k) {
    center[k] = 0.5 * static_cast<double>(group.center[k]) - faces.origin[k];
  }
  Sides sides;
  sides.error = faces.error * std::max(faces.reach, largest(center) + 0.5);
  std::array<double, 4> clearance;
  for (std::size_t f = 0; f < 4; ++f) {
    sides.center[f] = faces.normal[0][f] * center[0] + faces.normal[1][f] * center[1] +
                      faces.normal[2][f] * center[2] + faces.offset[f];
    clearance[f] = sides.center[f] - faces.extent[f] - 2 * sides.error;
  }
  unsigned near = 0;  // faces that corners may be outside of
  for (std::size_t f = 0; f < 4; ++f) near |= isNegative(clearance[f]) << f;
  for (near &= ~group.entered; near != 0; near &= near - 1) {
    const auto f = static_cast<std::size_t>(std::countr_zero(near));
    const std::array<double, 8> half = halfDiagonals(normalFor(faces, group, f));
    CellCornerSet notInside = 0;
    CellCornerSet outside = 0;
    for (CellCornerSet rest = group.corners; rest != 0; rest &= rest - 1) {
      const auto c = static_cast<std::size_t>(std::countr_zero(rest));
      // Without branches, which nobody could predict.
      notInside |= isNegative(sides.center[f] + half[c] - sides.error) << c;
      outside |= isNegative(sides.center[f] + half[c] + sides.error) << c;
    }
    const CellCornerSet unsure = notInside & ~outside;
    if (unsure != 0) outside |= signsOfUnsure(group.stop, f, z, unsure);
    sides.outside[f] = outside;
  }
  return sides;
}

/// A face's normal as the first tet's chart has it.
CellWalker::Vector CellWalker::normalFor(const Faces& faces, const Group& group,
                                         std::size_t face) noexcept {
  const Vector n = {faces.normal[0][face], faces.normal[1][face], faces.normal[2][face]};
  const Rotation& rotation = group.stop.toTet.rotation;
  if (rotation.isIdentity()) return n;
  Vector before;
  for (std::uint8_t k = 0; k < 3; ++k) {
    const Direction d = rotation(direction(k, 1));
    before[k] = n[static_cast<std::size_t>(axisOf(d))] * signOf(d);
  }
  return before;
}

/// Which of the corners lie outside of a face, by exact arithmetic in the tet's own chart.
CellCornerSet CellWalker::signsOfUnsure(const Stop& stop, std::size_t face, const GridPoint& z,
                                        CellCornerSet unsure) const {
  const LatticeTet& tet = map_.exact.corners[stop.tet];
  CellCornerSet outside = 0;
  for (; unsure != 0; unsure &= unsure - 1) {
    GridPoint corner = z;
    const auto c = static_cast<std::size_t>(std::countr_zero(unsure));
    for (std::size_t k = 0; k < 3; ++k) corner[k] += kCellCorners[c][k];
    corner = stop.toTet(corner);
    LatticePoint at{};
    for (std::size_t k = 0; k < 3; ++k) at[k] = corner[k] * map_.exact.unit;
    if (sideOfFace(tet, face, at) < 0) outside |= CellCornerSet{1} << c;
  }
  return outside;
}

/// Sends the corners that are not in the tet into its neighbours.
/// @return those that cannot be sent
CellCornerSet CellWalker::leave(const Faces& faces, const Group& group, const Sides& sides) {
  CellCornerSet once = 0;
  CellCornerSet twice = 0;
  for (const CellCornerSet outside : sides.outside) {
    twice |= once & outside;
    once |= outside;
  }
  std::array<CellCornerSet, 4> through{};
  for (std::size_t f = 0; f < 4; ++f) through[f] = sides.outside[f] & ~twice;
  CellCornerSet missed = 0;
  for (; twice != 0; twice &= twice - 1) {
    const auto c = static_cast<std::size_t>(std::countr_zero(twice));
    const int face = firstExit(faces, group, sides, c);
    (face < 0 ? missed : through[static_cast<std::size_t>(face)]) |= CellCornerSet{1} << c;
  }
  for (std::size_t f = 0; f < 4; ++f) {
    if (through[f] == 0) continue;
    if (stepsLeft_ == 0) {
      missed |= through[f];
      continue;
    }
    --stepsLeft_;
    cross(group, f, through[f]);
  }
  return missed;
}

/// The face through which the way to a corner outside of several faces leaves; -1 if that is not
/// certain.
int CellWalker::firstExit(const Faces& faces, const Group& group, const Sides& sides,
                          std::size_t corner) noexcept {
  // The plane of face f is reached at the fraction center / (center - value) of the way.
  int first = -1;
  double firstCenter = 0;
  double firstDepth = 0;
  for (std::size_t f = 0; f < 4; ++f) {
    if (((sides.outside[f] >> corner) & 1U) == 0) continue;
    const double center = sides.center[f];
    const double depth = -(center + halfDiagonals(normalFor(faces, group, f))[corner]);
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

/// Sends corners through a face, which is not on the boundary.
void CellWalker::cross(const Group& group, std::size_t face, CellCornerSet corners) {
  const TetTopology& topology = map_.topology;
  const Transitions& transitions = map_.exact.transitions;
  const HalfFace halfFace = halfFaceOf(group.stop.tet, static_cast<int>(face));
  const HalfFace mate = topology.mate[halfFace];
  Group& next = front_.emplace_back(group);
  next.corners = corners;
  next.entered = 1U << localOf(mate);
  next.stop.tet = tetOf(mate);
  if (next.stop.inSight) next.stop.inSight = charts_.isGlued(topology, transitions, halfFace);
  if (transitions.isJump(halfFace)) {
    const Transition& transition = transitions.across(halfFace);
    next.stop.toTet = transition * next.stop.toTet;
    next.center = transition(next.center, std::int64_t{2});
  }
}

}  // namespace hexhex
