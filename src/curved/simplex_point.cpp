#include <curved/simplex_point.hpp>

namespace hexhex {

namespace {

/// The last point of a face in whose plane the line runs. Seen in the plane of the line and a
/// coordinate r across it, the face is a triangle; the line leaves it through a side that rises in
/// r when the triangle is walked around counter-clockwise.
SimplexPoint exitOfFace(const LatticeTet& corners, int face, std::size_t along) noexcept {
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  const std::size_t p = (along + 1) % 3;
  bool flatInP = true;
  for (const int i : f) flatInP = flatInP && corners[static_cast<std::size_t>(i)][p] == 0;
  const std::size_t r = flatInP ? (along + 2) % 3 : p;
  const LatticePoint& a = corners[static_cast<std::size_t>(f[0])];
  const LatticePoint u = corners[static_cast<std::size_t>(f[1])] - a;
  const LatticePoint v = corners[static_cast<std::size_t>(f[2])] - a;
  const Int128 area = static_cast<Int128>(u[along]) * v[r] - static_cast<Int128>(u[r]) * v[along];
  for (std::size_t i = 0; i < 3; ++i) {
    auto from = static_cast<std::size_t>(f[i]);
    auto to = static_cast<std::size_t>(f[(i + 1) % 3]);
    if (area < 0) std::swap(from, to);
    const std::int64_t low = corners[from][r];
    const std::int64_t high = corners[to][r];
    if (low < high && low <= 0 && high >= 0) return SimplexPoint::between(from, to, low, high);
  }
  return {};
}

}  // namespace

SimplexPoint crossingOfFace(const LatticeTet& corners, int face, std::size_t along) noexcept {
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  SimplexPoint point;
  int side = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<std::size_t>(f[(i + 1) % 3]);
    const auto b = static_cast<std::size_t>(f[(i + 2) % 3]);
    const Int128 area = crossComponent(corners[a], corners[b], along);
    if (area == 0) continue;
    if (side != 0 && sign(area) != side) return {};
    side = sign(area);
    point.weights[static_cast<std::size_t>(f[i])] = area < 0 ? -area : area;
  }
  return point;
}

SimplexPoint exitPoint(const LatticeTet& corners, CornerMask simplex, std::size_t along) noexcept {
  if (dimension(simplex) == 2) return exitOfFace(corners, oppositeCorner(simplex), along);
  if (dimension(simplex) == 1) {
    const std::size_t a = firstCorner(simplex);
    const std::size_t b = lastCorner(simplex);
    return SimplexPoint::corner(corners[a][along] > corners[b][along] ? a : b);
  }
  for (int face = 0; face < 4; ++face) {
    // Through an exit face, whose inward normal looks back, all sides are negative or zero.
    const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
    SimplexPoint point;
    bool exit = true;
    for (std::size_t i = 0; i < 3 && exit; ++i) {
      const auto a = static_cast<std::size_t>(f[(i + 1) % 3]);
      const auto b = static_cast<std::size_t>(f[(i + 2) % 3]);
      const Int128 area = crossComponent(corners[a], corners[b], along);
      exit = area <= 0;
      point.weights[static_cast<std::size_t>(f[i])] = -area;
    }
    if (exit && point.simplex() != kNoSimplex) return point;
  }
  return {};
}

SimplexPoint exitInside(const LatticeTet& corners, int face) noexcept {
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  const auto a = static_cast<std::size_t>(f[0]);
  const auto b = static_cast<std::size_t>(f[1]);
  const auto c = static_cast<std::size_t>(f[2]);
  SimplexPoint point;
  point.weights[a] = -crossComponent(corners[b], corners[c], 0);
  point.weights[b] = -crossComponent(corners[c], corners[a], 0);
  point.weights[c] = -crossComponent(corners[a], corners[b], 0);
  if (point.weights[a] > 0 && point.weights[b] > 0 && point.weights[c] > 0) return point;
  return {};
}

SimplexPoint exitAfterEntry(const LatticeTet& corners, int entered) noexcept {
  // Seen along the line, the corners of the entry stand counter-clockwise around it. It leaves
  // through the face between two of them and the fourth corner that has the line inside.
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(entered)];
  const auto e = static_cast<std::size_t>(entered);
  std::array<Int128, 3> side;
  for (std::size_t i = 0; i < 3; ++i) {
    side[i] = crossComponent(corners[static_cast<std::size_t>(f[i])], corners[e], 0);
  }
  std::size_t i = 2;
  if (side[0] <= 0 && side[1] >= 0) {
    i = 0;
  } else if (side[1] <= 0 && side[2] >= 0) {
    i = 1;
  }
  const std::size_t j = i == 2 ? 0 : i + 1;
  const auto a = static_cast<std::size_t>(f[i]);
  const auto b = static_cast<std::size_t>(f[j]);
  SimplexPoint point;
  point.weights[e] = crossComponent(corners[a], corners[b], 0);
  point.weights[a] = side[j];
  point.weights[b] = -side[i];
  return point;
}

}  // namespace hexhex
