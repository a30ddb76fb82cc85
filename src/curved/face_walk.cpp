#include <base/prefetch.hpp>
#include <curved/face_walk.hpp>
#include <curved/simplex_point.hpp>

namespace hexhex {

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

/// A face as a line sees it that leaves through it.
struct SeenFace {
  std::array<std::uint8_t, 3> corners{};  ///< counter-clockwise
  std::array<std::uint8_t, 3> sides{};    ///< edge opposite each corner
};

constexpr std::array<SeenFace, 4> makeFaces() noexcept {
  std::array<SeenFace, 4> faces;
  for (std::size_t face = 0; face < 4; ++face) {
    const std::array<int, 3> f = {kFaceCorners[face][0], kFaceCorners[face][2],
                                  kFaceCorners[face][1]};
    for (std::size_t i = 0; i < 3; ++i) {
      faces[face].corners[i] = static_cast<std::uint8_t>(f[i]);
      faces[face].sides[i] = static_cast<std::uint8_t>(edgeOf(f[(i + 1) % 3], f[(i + 2) % 3]));
    }
  }
  return faces;
}
constexpr std::array<SeenFace, 4> kFaces = makeFaces();

/// By the edges (a bit each) whose second corner is to the left of the first: the face that a line
/// leaves through which none of them meets; 4 for sides that no line has.
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

EdgeSides::EdgeSides(const LatticeTet& seen) noexcept {
  for (std::size_t e = 0; e < 6; ++e) {
    const Int128 product = crossComponent(seen[kEdges[e][0]], seen[kEdges[e][1]], 0);
    left |= static_cast<unsigned>(product > 0) << e;
    touches |= product == 0;
  }
}

bool FaceWalk::start(const SimplexInTet& at, const LatticeTet& seen, const EdgeSides& sides,
                     Way way) {
  // Looking back, left is right.
  const bool back = way == Way::Backward;
  const std::size_t face = kExits[back ? ~sides.left & 63U : sides.left];
  if (sides.touches || face == 4) return false;
  leaveThrough(at.tet, static_cast<int>(face));
  looked_ = false;
  const SeenFace& f = kFaces[face];
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticePoint& p = seen[f.corners[i]];
    vertices_[i] = topology_.tets[at.tet][f.corners[i]];
    seen_[i] = back ? LatticePoint{exact_.unit - p[0], -p[1], p[2]} : p;
  }
  return true;
}

void FaceWalk::resume(const SimplexInTet& at, int face) {
  leaveThrough(at.tet, face);
  look(at.frame);
  const std::array<std::uint8_t, 3>& corners = kFaces[static_cast<std::size_t>(face)].corners;
  for (std::size_t i = 0; i < 3; ++i) {
    vertices_[i] = topology_.tets[at.tet][corners[i]];
    seen_[i] = seen(exact_.corners[at.tet][corners[i]]);
  }
}

bool FaceWalk::cross(SimplexInTet& at) {
  if (mate_ == kNone) return false;
  const HalfFace halfFace = halfFaceOf(at.tet, face_);
  at.tet = tetOf(mate_);
  face_ = localOf(mate_);
  if (at.frame.cross(exact_.transitions, halfFace)) looked_ = false;
  // The next point is in a face with the corner opposite this one.
  prefetch(&map_.input.view.points[topology_.tets[at.tet][static_cast<std::size_t>(face_)]]);
  return true;
}

bool FaceWalk::leave(const SimplexInTet& at) {
  if (!looked_) look(at.frame);
  const auto apex = static_cast<std::size_t>(face_);
  const LatticePoint seen = this->seen(exact_.corners[at.tet][apex]);
  // The edge leaves between two corners, and the apex, that it has inside: those where the apex is
  // to the right of the first and to the left of the second.
  unsigned right = 0;
  unsigned left = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Int128 product = crossComponent(seen_[i], seen, 0);
    right |= static_cast<unsigned>(product < 0) << i;
    left |= static_cast<unsigned>(product > 0) << i;
  }
  constexpr std::array<std::uint8_t, 8> kFirst = {3, 0, 1, 3, 2, 3, 3, 3};
  const std::size_t first = kFirst[right & ((left >> 1) | (left << 2)) & 7U];
  if (first == 3) return false;
  const std::size_t second = first == 2 ? 0 : first + 1;
  const std::size_t third = 3 - first - second;
  leaveThrough(at.tet, topology_.localCorner(at.tet, vertices_[third]));
  vertices_[third] = topology_.tets[at.tet][apex];
  seen_[third] = seen;
  return true;
}

/// Memory takes longer to answer than all arithmetic here, so it is asked early.
void FaceWalk::leaveThrough(Index tet, int face) noexcept {
  face_ = face;
  const HalfFace own = halfFaceOf(tet, face);
  mate_ = topology_.mate[own];
  const HalfFace next = mate_ == kNone ? own : mate_;
  // What the jump is has been asked for one tet before, so it is known which transition it takes.
  prefetch(&exact_.transitions.table[exact_.transitions.jump[own]]);
  prefetch(&exact_.transitions.jump[halfFaceOf(tetOf(next), 0)]);
  // The corner opposite the face, and the face itself if the next tet owns it.
  prefetch(exact_.corners[tetOf(next)].front().data());
  prefetch(&exact_.corners[tetOf(next)].back().back());
  prefetch(topology_.tets[tetOf(next)].data());
  prefetch(&topology_.mate[halfFaceOf(tetOf(next), 0)]);
}

void FaceWalk::look(const Frame& frame) noexcept {
  looked_ = true;
  for (std::size_t k = 0; k < 3; ++k) {
    axis_[k] = static_cast<std::size_t>(axisOf(frame.axes[k]));
    zero_[k] = frame.origin[axis_[k]] * exact_.unit;
    flip_[k] = signOf(frame.axes[k]) < 0 ? -1 : 0;
  }
}

}  // namespace hexhex
