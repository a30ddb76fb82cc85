#include <curved/simplex_point.hpp>

namespace hexhex::curved {

namespace {

/// The last point of a face whose plane contains the line. In that plane, with a coordinate r
/// across the line, the face is a triangle; the line leaves it through a side along which r
/// increases as the triangle is traversed counter-clockwise.
SimplexPoint exitOfFace(const lattice::LatticeTet& corners, int face, std::size_t along) noexcept {
  const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(face)];
  const std::size_t p = (along + 1) % 3;
  bool flatInP = true;
  for (const int i : f) flatInP = flatInP && corners[static_cast<std::size_t>(i)][p] == 0;
  const std::size_t r = flatInP ? (along + 2) % 3 : p;
  const lattice::LatticePoint& a = corners[static_cast<std::size_t>(f[0])];
  const lattice::LatticePoint u = corners[static_cast<std::size_t>(f[1])] - a;
  const lattice::LatticePoint v = corners[static_cast<std::size_t>(f[2])] - a;
  const lattice::Int128 area =
      static_cast<lattice::Int128>(u[along]) * v[r] - static_cast<lattice::Int128>(u[r]) * v[along];
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

SimplexPoint intersectionWithFace(const lattice::LatticeTet& corners, int face,
                                  std::size_t along) noexcept {
  const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(face)];
  SimplexPoint point;
  bool positive = false;
  bool negative = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<std::size_t>(f[(i + 1) % 3]);
    const auto b = static_cast<std::size_t>(f[(i + 2) % 3]);
    const lattice::Int128 area = lattice::crossComponent(corners[a], corners[b], along);
    positive = positive || area > 0;
    negative = negative || area < 0;
    point.weights[static_cast<std::size_t>(f[i])] = area < 0 ? -area : area;
  }
  if (positive && negative) return {};
  return point;
}

SimplexPoint exitPoint(const lattice::LatticeTet& corners, lattice::CornerMask simplex,
                       std::size_t along) noexcept {
  if (lattice::dimension(simplex) == 2)
    return exitOfFace(corners, lattice::oppositeCorner(simplex), along);
  if (lattice::dimension(simplex) == 1) {
    const std::size_t a = lattice::firstCorner(simplex);
    const std::size_t b = lattice::lastCorner(simplex);
    return SimplexPoint::corner(corners[a][along] > corners[b][along] ? a : b);
  }
  for (int face = 0; face < 4; ++face) {
    // For an exit face, whose inward normal points backward, all sides are negative or zero.
    const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(face)];
    SimplexPoint point;
    bool exit = true;
    for (std::size_t i = 0; i < 3 && exit; ++i) {
      const auto a = static_cast<std::size_t>(f[(i + 1) % 3]);
      const auto b = static_cast<std::size_t>(f[(i + 2) % 3]);
      const lattice::Int128 area = lattice::crossComponent(corners[a], corners[b], along);
      exit = area <= 0;
      point.weights[static_cast<std::size_t>(f[i])] = -area;
    }
    if (exit && point.simplex() != lattice::kNoSimplex) return point;
  }
  return {};
}

}  // namespace hexhex::curved
