#include <base/low_level.hpp>
#include <curved/face_walk.hpp>

namespace hexhex::curved {

namespace {

/// The edges of a tet, by corners in order.
constexpr std::array<std::array<std::uint8_t, 2>, 6> kEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

constexpr std::size_t edgeOf(int a, int b) noexcept {
  for (std::size_t e = 0; e < 6; ++e) {
    if (kEdges[e][0] == (a < b ? a : b) && kEdges[e][1] == (a < b ? b : a)) return e;
  }
  return 6;
}

/// A face as seen by a line that leaves through it.
struct SeenFace {
  std::array<std::uint8_t, 3> corners{};  ///< counter-clockwise
  std::array<std::uint8_t, 3> sides{};    ///< edge opposite each corner
};

constexpr std::array<SeenFace, 4> makeFaces() noexcept {
  std::array<SeenFace, 4> faces;
  for (std::size_t face = 0; face < 4; ++face) {
    const std::array<int, 3> f = {lattice::kFaceCorners[face][0], lattice::kFaceCorners[face][2],
                                  lattice::kFaceCorners[face][1]};
    for (std::size_t i = 0; i < 3; ++i) {
      faces[face].corners[i] = static_cast<std::uint8_t>(f[i]);
      faces[face].sides[i] = static_cast<std::uint8_t>(edgeOf(f[(i + 1) % 3], f[(i + 2) % 3]));
    }
  }
  return faces;
}
constexpr std::array<SeenFace, 4> kFaces = makeFaces();

/// Indexed by the set of edges (a bit each) whose second corner is to the left of the first: the
/// face through which a line leaves that meets none of the edges; 4 for combinations that no line
/// has.
constexpr std::array<std::uint8_t, 64> makeExits() noexcept {
  std::array<std::uint8_t, 64> exits{};
  for (unsigned bits = 0; bits < 64; ++bits) {
    exits[bits] = 4;
    for (std::size_t face = 0; face < 4; ++face) {
      bool inside = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const bool left = ((bits >> kFaces[face].sides[i]) & 1U) != 0;
        const bool forward = kFaces[face].corners[(i + 1) % 3] < kFaces[face].corners[(i + 2) % 3];
        inside = inside && left == forward;
      }
      if (inside) exits[bits] = static_cast<std::uint8_t>(face);
    }
  }
  return exits;
}
constexpr std::array<std::uint8_t, 64> kExits = makeExits();

}  // namespace

EdgeSides::EdgeSides(const lattice::LatticeTet& seen) noexcept {
  for (std::size_t e = 0; e < 6; ++e) {
    const lattice::Int128 product =
        lattice::crossComponent(seen[kEdges[e][0]], seen[kEdges[e][1]], 0);
    if (product > 0) left |= 1U << e;
    if (product == 0) touches = true;
  }
}

bool FaceWalk::start(const SimplexInTet& at, const lattice::LatticeTet& seen,
                     const EdgeSides& sides, Heading heading) {
  // Looking backward, left becomes right.
  const bool back = heading == Heading::Backward;
  const int face = kExits[back ? ~sides.left & 63U : sides.left];
  if (sides.touches || face == 4) return false;
  leaveThrough(at.tet, face);
  const SeenFace& f = kFaces[static_cast<std::size_t>(face_)];
  for (std::size_t i = 0; i < 3; ++i) {
    const lattice::LatticePoint& p = seen[f.corners[i]];
    vertices_[i] = topology_.tets[at.tet][f.corners[i]];
    seen_[i] = back ? lattice::LatticePoint{exact_.unit - p[0], -p[1], p[2]} : p;
  }
  return true;
}

/// Prefetches the tet behind the face: without this, arcs take 7 to 9 % longer where tets are
/// smaller than cells, and a whole extraction with arcs takes 3 % longer.
void FaceWalk::leaveThrough(Index tet, int face) noexcept {
  face_ = face;
  mate_ = topology_.mate[adjacency::halfFaceOf(tet, face)];
  if (mate_ == kNone) return;
  const Index next = adjacency::tetOf(mate_);
  prefetch(exact_.corners[next].front().data());
  prefetch(&exact_.corners[next].back().back());
  prefetch(topology_.tets[next].data());
  prefetch(&topology_.mate[adjacency::halfFaceOf(next, 0)]);
}

bool FaceWalk::cross(SimplexInTet& at) {
  const adjacency::HalfFace halfFace = adjacency::halfFaceOf(at.tet, face_);
  if (mate_ == kNone) return false;
  at.tet = adjacency::tetOf(mate_);
  at.frame.cross(exact_.transitions, halfFace);
  face_ = adjacency::localOf(mate_);
  return true;
}

bool FaceWalk::leave(const SimplexInTet& at) {
  const auto apex = static_cast<std::size_t>(face_);
  const lattice::LatticePoint seen = at.frame.see(exact_.corners[at.tet][apex], exact_.unit);
  // The edge leaves between two corners and the apex, on the sides that enclose it: those where the
  // apex is to the right of the first corner and to the left of the second.
  std::array<int, 3> side{};
  for (std::size_t i = 0; i < 3; ++i)
    side[i] = lattice::sign(lattice::crossComponent(seen_[i], seen, 0));
  for (std::size_t first = 0; first < 3; ++first) {
    const std::size_t second = (first + 1) % 3;
    if (side[first] >= 0 || side[second] <= 0) continue;
    const std::size_t third = 3 - first - second;
    leaveThrough(at.tet, topology_.localCorner(at.tet, vertices_[third]));
    vertices_[third] = topology_.tets[at.tet][apex];
    seen_[third] = seen;
    return true;
  }
  return false;
}

}  // namespace hexhex::curved
