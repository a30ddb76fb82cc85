#include <algorithm>
#include <cmath>
#include <utility>

#include <base/vector3.hpp>
#include <lattice/cell_corners.hpp>
#include <lattice/tet_geometry.hpp>
#include <repair/cell_flood.hpp>
#include <repair/valid_tets.hpp>

namespace hexhex::repairs {

namespace {

/// Triangle parts smaller than this merely touch.
constexpr double kLeastArea = 1e-12;
/// A point closer to a wall than this is in the wall.
constexpr double kWall = 1e-9;

/// The wall that a point is in (2 * axis, plus 1 for the high one), or -1.
int wallOf(const Vec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    const double x = point[static_cast<std::size_t>(axis)];
    if (x < kWall) return 2 * axis;
    if (x > 1 - kWall) return 2 * axis + 1;
  }
  return -1;
}

/// The four barycentric weights of a point in a tet, times the tet's determinant.
std::array<lattice::Int192, 4> weightsOf(const lattice::LatticeTet& c,
                                         const lattice::LatticePoint& at) {
  return {lattice::orientationDeterminant(at, c[1], c[2], c[3]),
          lattice::orientationDeterminant(c[0], at, c[2], c[3]),
          lattice::orientationDeterminant(c[0], c[1], at, c[3]),
          lattice::orientationDeterminant(c[0], c[1], c[2], at)};
}

lattice::Int128 squaredDistance(const lattice::LatticePoint& a, const lattice::LatticePoint& b) {
  lattice::Int128 sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const lattice::Int128 d = static_cast<lattice::Int128>(a[k]) - b[k];
    sum += d * d;
  }
  return sum;
}

using Polygon = std::vector<Vec3>;

/// Keeps the side of a plane across an axis where (x - level) * sign >= 0. (Sutherland and Hodgman,
/// "Reentrant polygon clipping", 1974)
void clip(Polygon& polygon, std::size_t axis, double level, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double da = (a[axis] - level) * sign;
    const double db = (b[axis] - level) * sign;
    if (da >= 0) kept.push_back(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      const double share = da / (da - db);
      Vec3 cut{};
      for (std::size_t k = 0; k < 3; ++k) cut[k] = a[k] + share * (b[k] - a[k]);
      cut[axis] = level;
      kept.push_back(cut);
    }
  }
  polygon = std::move(kept);
}

/// A convex body, given by its faces.
using Body = std::vector<Polygon>;

/// The new face left by a cut along a plane: the corners of the other faces on the plane, sorted by
/// angle, counter-clockwise as seen from where the axis points.
Polygon capOf(const Body& body, std::size_t axis, double level) {
  Polygon cap;
  Vec3 middle{};
  for (const Polygon& face : body) {
    for (const Vec3& corner : face) {
      if (corner[axis] == level) cap.push_back(corner);
    }
  }
  for (const Vec3& corner : cap) {
    for (std::size_t k = 0; k < 3; ++k) middle[k] += corner[k] / static_cast<double>(cap.size());
  }
  const std::size_t j = (axis + 1) % 3;
  const std::size_t l = (axis + 2) % 3;
  const auto angle = [&](const Vec3& corner) {
    return std::atan2(corner[l] - middle[l], corner[j] - middle[j]);
  };
  std::sort(cap.begin(), cap.end(),
            [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
  return cap;
}

bool liesIn(const Polygon& face, std::size_t axis, double level) {
  for (const Vec3& corner : face) {
    if (corner[axis] != level) return false;
  }
  return true;
}

/// Volume of a closed body whose faces are counter-clockwise from outside.
double volumeOf(const Body& body, const Vec3& from) {
  double volume = 0;
  for (const Polygon& face : body) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      volume += tripleProduct(minus(face[0], from), minus(face[i], from), minus(face[i + 1], from));
    }
  }
  return volume / 6;
}

}  // namespace

bool CellFlood::run(Index tet, const lattice::GridPoint& low) {
  low_ = low;
  pieces_.clear();
  wallArea_ = {};
  if (!visit(tet, {})) return false;
  for (std::size_t head = 0; head < pieces_.size(); ++head) {
    if (!spread(head)) return false;
  }
  double volume = 0;
  for (const Piece& piece : pieces_) volume += piece.volume;
  return std::abs(volume - 1) < kSlack;
}

std::array<Vec3, 4> CellFlood::relative(const lattice::LatticeTet& corners) const {
  const auto unit = static_cast<double>(map_.exact.unit);
  std::array<Vec3, 4> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[i][k] =
          static_cast<double>(corners[i][k] - std::int64_t{low_[k]} * map_.exact.unit) / unit;
    }
  }
  return result;
}

/// False if the tet has been reached at another place of the chart: the cell wraps around
/// something.
bool CellFlood::visit(Index tet, const lattice::Transition& fromFirst) {
  for (const Piece& piece : pieces_) {
    if (piece.tet == tet) return piece.fromFirst == fromFirst;
  }
  Piece piece{tet, fromFirst, map_.exact.corners[tet], 0};
  if (!fromFirst.isIdentity()) {
    piece.corners = fromFirst.inverse()(piece.corners, map_.exact.unit);
  }
  piece.volume = volumeInCube(relative(piece.corners));
  pieces_.push_back(piece);
  return true;
}

bool CellFlood::spread(std::size_t index) {
  const Piece piece = pieces_[index];
  const std::array<Vec3, 4> corners = relative(piece.corners);
  for (int f = 0; f < 4; ++f) {
    const std::array<int, 3>& face = lattice::kFaceCorners[static_cast<std::size_t>(f)];
    const ClippedTriangle part = clipToCube({corners[static_cast<std::size_t>(face[0])],
                                             corners[static_cast<std::size_t>(face[1])],
                                             corners[static_cast<std::size_t>(face[2])]});
    if (part.area < kLeastArea) continue;
    const adjacency::HalfFace halfFace = adjacency::halfFaceOf(piece.tet, f);
    const adjacency::HalfFace mate = map_.topology.mate[halfFace];
    const int wall = wallOf(part.centre);
    if (wall >= 0) {
      if (mate == kNone) wallArea_[static_cast<std::size_t>(wall)] += part.area;
      continue;
    }
    if (mate == kNone || valid_[adjacency::tetOf(mate)] == 0 || !isCarriedOver(map_, halfFace))
      return false;
    if (!visit(adjacency::tetOf(mate), map_.exact.transitions.across(halfFace) * piece.fromFirst)) {
      return false;
    }
  }
  return true;
}

std::optional<CellFlood::Corner> CellFlood::corner(std::size_t i) const {
  lattice::LatticePoint at{};
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = (std::int64_t{low_[k]} + lattice::kCellCorners[i][k]) * map_.exact.unit;
  }
  // Every piece that touches the corner gives the same answer.
  for (const Piece& piece : pieces_) {
    const std::array<lattice::Int192, 4> weights = weightsOf(piece.corners, at);
    lattice::CornerMask simplex = 0;
    bool inside = true;
    double sum = 0;
    for (int c = 0; c < 4; ++c) {
      const lattice::Int192& weight = weights[static_cast<std::size_t>(c)];
      inside = inside && weight.sign() >= 0;
      if (weight.sign() > 0)
        simplex = static_cast<lattice::CornerMask>(simplex | lattice::cornerBit(c));
      sum += weight.toDouble();
    }
    if (!inside) continue;
    Corner corner{nameOf(piece, simplex, at), {}};
    const Tet& tet = map_.topology.tets[piece.tet];
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        corner.position[k] += weights[c].toDouble() / sum * map_.input.view.points[tet[c]][k];
      }
    }
    return corner;
  }
  return {};
}

VertexName CellFlood::nameOf(const Piece& piece, lattice::CornerMask simplex,
                             const lattice::LatticePoint& at) const {
  const Tet& tet = map_.topology.tets[piece.tet];
  VertexName name;
  std::vector<int> corners;
  for (int c = 0; c < 4; ++c) {
    if (lattice::contains(simplex, c)) corners.push_back(c);
  }
  std::sort(corners.begin(), corners.end(), [&](int a, int b) {
    return tet[static_cast<std::size_t>(a)] < tet[static_cast<std::size_t>(b)];
  });
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto c = static_cast<std::size_t>(corners[i]);
    name.simplex[i] = tet[c];
    if (corners.size() == 2 || corners.size() == 3) {
      name.place[i] = squaredDistance(piece.corners[c], at);
    }
  }
  if (simplex == lattice::kWholeTet) {
    const lattice::LatticePoint own = piece.fromFirst(at, map_.exact.unit);
    for (std::size_t k = 0; k < 3; ++k) name.place[k] = own[k];
  }
  return name;
}

double volumeInCube(const std::array<Vec3, 4>& tet) {
  Body body;
  for (const std::array<int, 3>& face : lattice::kFaceCorners) {
    // Outward.
    body.push_back({tet[static_cast<std::size_t>(face[0])], tet[static_cast<std::size_t>(face[2])],
                    tet[static_cast<std::size_t>(face[1])]});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double level : {0.0, 1.0}) {
      for (Polygon& face : body) clip(face, axis, level, level == 0 ? 1 : -1);
      std::erase_if(
          body, [&](const Polygon& face) { return face.size() < 3 || liesIn(face, axis, level); });
      if (body.empty()) return 0;
      Polygon cap = capOf(body, axis, level);
      if (cap.size() < 3) continue;
      if (level == 0) std::reverse(cap.begin(), cap.end());
      body.push_back(std::move(cap));
    }
  }
  return volumeOf(body, {0.5, 0.5, 0.5});
}

ClippedTriangle clipToCube(const std::array<Vec3, 3>& triangle) {
  Polygon polygon(triangle.begin(), triangle.end());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    clip(polygon, axis, 0, 1);
    clip(polygon, axis, 1, -1);
  }
  ClippedTriangle clipped;
  Vec3 weighted{};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double area =
        0.5 * length(cross(minus(polygon[i], polygon[0]), minus(polygon[i + 1], polygon[0])));
    clipped.area += area;
    for (std::size_t k = 0; k < 3; ++k) {
      weighted[k] += area * (polygon[0][k] + polygon[i][k] + polygon[i + 1][k]) / 3;
    }
  }
  if (clipped.area > 0) {
    for (std::size_t k = 0; k < 3; ++k) clipped.centre[k] = weighted[k] / clipped.area;
  }
  return clipped;
}

}  // namespace hexhex::repairs
