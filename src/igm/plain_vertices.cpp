#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

#include <base/bits.hpp>
#include <base/branchless.hpp>
#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <igm/plain_vertices.hpp>
#include <igm/tet_projection.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = PlainVertices::kBlock;

/// Tets whose parameters, 96 bytes each, are still in the innermost cache when they are looked at
/// for the second time.
constexpr std::size_t kNear = 128;

/// Calls f(begin, end) for parts of a block.
template <class F>
void forEachPart(std::size_t begin, std::size_t end, const F& f) {
  for (std::size_t part = begin; part < end; part += kNear) f(part, std::min(end, part + kNear));
}

/// Faces between asking for a tet and looking at it: the memory's delay, in steps of a loop.
constexpr std::size_t kPrefetchDistance = 12;

/// Sets a flag that several threads may set.
void mark(std::uint8_t& flag) { std::atomic_ref(flag).store(1, std::memory_order_relaxed); }

void markCorners(const Tet& tet, int face, PlainVertices& result) {
  for (const int corner : kFaceCorners[static_cast<std::size_t>(face)]) {
    mark(result.special[tet[static_cast<std::size_t>(corner)]]);
  }
}

/// At most four things for each tet of a part, listed without a branch: which ones belong
/// there is as good as random.
class BranchlessList {
 public:
  void clear() { count_ = 0; }
  void add(std::uint32_t entry, bool wanted) {
    entries_[count_] = entry;
    count_ += wanted ? 1 : 0;
  }
  [[nodiscard]] std::span<const std::uint32_t> get() const { return {entries_.data(), count_}; }

 private:
  std::array<std::uint32_t, 4 * kNear + 1> entries_;  // NOLINT: written before it is read
  std::size_t count_ = 0;
};

/// The axes along which a triangle is constant, as bits.
unsigned constantAxes(const Vec3& p, const Vec3& q, const Vec3& r) {
  const Pair xy = {p[0], p[1]};
  const PairMask isConstant = (xy == Pair{q[0], q[1]}) & (xy == Pair{r[0], r[1]});
  const PairMask third = Pair{p[2], p[2]} == Pair{q[2], r[2]};
  return static_cast<unsigned>((isConstant[0] & 1) | (isConstant[1] & 2) |
                               (third[0] & third[1] & 4));
}

/// Lists the boundary faces of some tets.
void listBoundary(const TetTopology& topology, const LocalParameters& parameters, std::size_t begin,
                  std::size_t end, std::size_t block, PlainVertices& result) {
  BranchlessList list;
  for (auto h = static_cast<HalfFace>(4 * begin); h < 4 * end; ++h) {
    list.add(h, topology.mate[h] == kNone);
  }
  std::fill(&result.passages[4 * begin], &result.passages[4 * begin] + 4 * (end - begin),
            Passage());
  Array<PlainVertices::BoundaryFace>& faces = result.boundaryFaces[block];
  faces.resize(faces.size() + list.get().size());
  PlainVertices::BoundaryFace* next = faces.data() + faces.size() - list.get().size();
  for (const HalfFace halfFace : list.get()) {
    TetParameters scratch;
    const TetParameters& u = parameters.see(tetOf(halfFace), scratch);
    const std::array<int, 3>& corners = kFaceCorners[halfFace % 4];
    const Vec3& p = u[static_cast<std::size_t>(corners[0])];
    const Vec3& q = u[static_cast<std::size_t>(corners[1])];
    const Vec3& r = u[static_cast<std::size_t>(corners[2])];
    const unsigned constant = constantAxes(p, q, r);
    const std::size_t axis = hasOneBit(constant)
                                 ? static_cast<std::size_t>(std::countr_zero(constant))
                                 : dominantAxis(cross(minus(q, p), minus(r, p)));
    // The general direction, positive along all axes, leads inward where the tet is above.
    const bool isAbove = u[halfFace % 4][axis] > p[axis];
    *next++ = {halfFace, static_cast<std::uint16_t>(axis), static_cast<std::uint8_t>(constant),
               isAbove};
    result.passages[halfFace] = Passage::boundary(axis, constant == 1U << axis);
  }
}

/// In PlainVertices::plane until all cones are counted: the planes that a tet is below at one of
/// its boundary faces, where mirrored directions count, too.
constexpr unsigned kBelow = 8;

/// Notes the planes of boundary faces at their corners; without a plane, these are special. One
/// thread does so for all, as faces share most of their corners, and are few.
void notePlanes(const TetTopology& topology, PlainVertices& result) {
  for (const Array<PlainVertices::BoundaryFace>& faces : result.boundaryFaces) {
    for (const PlainVertices::BoundaryFace& face : faces) {
      const Tet& tet = topology.tets[tetOf(face.halfFace)];
      if (face.constantAxes == 0) markCorners(tet, localOf(face.halfFace), result);
      const unsigned planes = face.constantAxes * (face.isAbove ? 1 : 1 + kBelow);
      for (const int corner : kFaceCorners[face.halfFace % 4]) {
        std::uint8_t& plane = result.plane[tet[static_cast<std::size_t>(corner)]];
        plane = static_cast<std::uint8_t>(plane | planes);
      }
    }
  }
}

/// Finds out how the direction lies to tets, and counts cones: of the tets, and of their mirror
/// images at vertices that are on one boundary plane, unless they are above it everywhere.
class TetSurvey {
 public:
  /// @param cones  per vertex: tets in one and the same direction from it
  TetSurvey(const TetTopology& topology, const LocalParameters& parameters, std::span<Index> cones,
            PlainVertices& result)
      : topology_(topology), parameters_(parameters), cones_(cones), result_(result) {}

  /// For at most kNear tets.
  void run(std::size_t begin, std::size_t end) {
    found_.clear();
    images_.clear();
    for (std::size_t t = begin; t < end; t += 2) lookAtTwo(t, std::min(t + 1, end - 1));
    const std::span<const std::uint32_t> images = images_.get();
    for (std::size_t i = 0; i < images.size(); i += 2) {
      lookAtTwoImages(images[i], images[std::min(i + 1, images.size() - 1)]);
    }
    for (const Index vertex : found_.get()) {
      std::atomic_ref(cones_[vertex]).fetch_add(1, std::memory_order_relaxed);
    }
  }

 private:
  /// @param second  may be the first again
  void lookAtTwo(std::size_t first, std::size_t second) {
    const auto t = static_cast<Index>(first);
    const auto next = static_cast<Index>(second);
    std::array<TetParameters, 2> scratch;  // NOLINT: written before it is read
    const TetProjections projections(parameters_.see(t, scratch[0]),
                                     parameters_.see(next, scratch[1]));
    const std::array<TetSides, 2> sides = projections.sides(kGeneralDirection, kGeneralDirection);
    note(t, sides[0]);
    if (next != t) note(next, sides[1]);
  }

  void note(Index t, TetSides sides) {
    const Tet& tet = topology_.tets[t];
    result_.sides[t] = sides;
    if (sides == kUncertainSides) {
      markAll(tet);
      for (std::size_t f = 0; f < 4; ++f) result_.passages[4 * t + f].roughen();
      return;
    }
    const std::size_t corner = coneCorner(sides);
    found_.add(tet[corner % 4], corner != 4);
    unsigned planes = 0;
    for (const Index v : tet) planes |= result_.plane[v];
    for (unsigned axis = 0; axis < 3; ++axis) {
      images_.add(4 * t + axis, ((planes >> axis) & kBelow) != 0);
    }
  }

  /// @param first, second  tets, and the axes along which to mirror the direction (in the two
  ///                       lowest bits)
  void lookAtTwoImages(std::uint32_t first, std::uint32_t second) {
    std::array<TetParameters, 2> scratch;  // NOLINT: written before it is read
    const TetProjections projections(parameters_.see(first / 4, scratch[0]),
                                     parameters_.see(second / 4, scratch[1]));
    const std::array<TetSides, 2> sides =
        projections.sides(kMirrored[first % 4], kMirrored[second % 4]);
    noteImage(first, sides[0]);
    if (second != first) noteImage(second, sides[1]);
  }

  void noteImage(std::uint32_t image, TetSides sides) {
    const Tet& tet = topology_.tets[image / 4];
    // The mirrored direction may be in a face of the tet.
    if (sides == kUncertainSides) {
      markAll(tet);
      return;
    }
    // On two planes, a vertex is special anyway.
    const std::size_t corner = coneCorner(sides);
    const Index vertex = tet[corner % 4];
    found_.add(vertex, allOf(corner != 4, result_.plane[vertex] == (1 + kBelow) << (image % 4)));
  }

  void markAll(const Tet& tet) {
    for (const Index v : tet) mark(result_.special[v]);
  }

  static constexpr std::array<Vec3, 3> kMirrored = {mirrored(kGeneralDirection, 0),
                                                    mirrored(kGeneralDirection, 1),
                                                    mirrored(kGeneralDirection, 2)};

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  std::span<Index> cones_;
  PlainVertices& result_;
  BranchlessList found_;   ///< vertices
  BranchlessList images_;  ///< as in lookAtTwoImages()
};

/// The bits of two numbers in a row.
PairMask bitsOfPair(const double* first) { return reinterpret_cast<PairMask>(loadPair(first)); }

/// The corners of a half-face in ascending order of vertices.
const std::array<std::uint8_t, 3>& ascendingCorners(const TetTopology& topology,
                                                    HalfFace halfFace) {
  return kAscendingFaceCorners[topology.order[tetOf(halfFace)]][halfFace % 4];
}

/// Whether they have the same bits there: the same as agree(), if true.
bool areSame(const TetTopology& topology, const LocalParameters& parameters, HalfFace here,
             HalfFace there) {
  const TetParameters& u = parameters.given(tetOf(here));
  const TetParameters& v = parameters.given(tetOf(there));
  const std::array<std::uint8_t, 3>& corners = ascendingCorners(topology, here);
  const std::array<std::uint8_t, 3>& others = ascendingCorners(topology, there);
  PairMask difference = {0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& a = u[corners[k]];
    const Vec3& b = v[others[k]];
    // Two overlapping pairs have all three coordinates.
    difference |= bitsOfPair(&a[0]) ^ bitsOfPair(&b[0]);
    difference |= bitsOfPair(&a[1]) ^ bitsOfPair(&b[1]);
  }
  return (difference[0] | difference[1]) == 0;
}

/// Looks at each inner face of some tets, from its larger half-face: the parameters of the
/// other tet have then been looked at not long ago.
void surveyFaces(const TetTopology& topology, const LocalParameters& parameters, std::size_t begin,
                 std::size_t end, std::size_t block, PlainVertices& result) {
  BranchlessList inner;
  for (auto h = static_cast<HalfFace>(4 * begin); h < 4 * end; ++h) {
    inner.add(h, topology.mate[h] < h);
  }
  BranchlessList unequal;
  const std::span<const HalfFace> faces = inner.get();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::size_t ahead = std::min(i + kPrefetchDistance, faces.size() - 1);
    parameters.prefetch(tetOf(topology.mate[faces[ahead]]));
    const HalfFace there = topology.mate[faces[i]];
    unequal.add(faces[i], parameters.moved() || !areSame(topology, parameters, faces[i], there));
  }
  Array<HalfFace>& found = result.unequalFaces[block];
  for (const HalfFace here : unequal.get()) {
    const HalfFace there = topology.mate[here];
    if (agree(topology, parameters, here, there)) continue;
    markCorners(topology.tets[tetOf(here)], localOf(here), result);
    result.passages[here].roughen();
    result.passages[there].roughen();
    found.push_back(here);
  }
}

}  // namespace

TetSides computeSides(const TetParameters& u) noexcept {
  return TetProjections(u, u).sides(kGeneralDirection, kGeneralDirection)[0];
}

TetSides computeMirroredSides(const TetParameters& u, std::size_t axis) noexcept {
  const Vec3 direction = mirrored(kGeneralDirection, axis);
  return TetProjections(u, u).sides(direction, direction)[0];
}

PlainVertices findPlainVertices(const TetTopology& topology, const LocalParameters& parameters,
                                Stage& stage) {
  const std::size_t vertices = topology.pointCount;
  PlainVertices result;
  Array<std::uint8_t>& special = result.special;
  special.assign(vertices, 0);
  result.plane.assign(vertices, 0);
  Array<Index> cones(vertices, 0);
  result.sides.resize(topology.tetCount());
  result.passages.resize(4 * topology.tetCount());
  const std::size_t tets = topology.tetCount();
  result.boundaryFaces.resize(blockCount(tets, kGrain));
  result.unequalFaces.resize(blockCount(tets, kGrain));
  parallelBlocks(stage, tets, kGrain, [&](std::size_t first, std::size_t last, std::size_t block) {
    forEachPart(first, last, [&](std::size_t begin, std::size_t end) {
      listBoundary(topology, parameters, begin, end, block, result);
    });
  });
  notePlanes(topology, result);
  std::uint64_t boundaryFaces = 0;
  for (const auto& faces : result.boundaryFaces) boundaryFaces += faces.size();
  result.innerFaces = (4 * tets - boundaryFaces) / 2;
  parallelBlocks(stage, tets, kGrain, [&](std::size_t first, std::size_t last, std::size_t block) {
    TetSurvey tetSurvey(topology, parameters, cones, result);
    forEachPart(first, last, [&](std::size_t begin, std::size_t end) {
      tetSurvey.run(begin, end);
      surveyFaces(topology, parameters, begin, end, block, result);
    });
  });
  parallelFor(stage, vertices, kGrain, [&](std::size_t v) {
    const unsigned planes = result.plane[v] % kBelow;
    result.plane[v] = static_cast<std::uint8_t>(planes);
    // On two planes, all cones are counted in vain.
    const bool manyPlanes = hasManyBits(planes);
    if ((cones[v] != 1 || manyPlanes) && !topology.isIsolated(static_cast<Index>(v))) {
      special[v] = 1;
    }
  });
  return result;
}

}  // namespace hexhex
