// Counts the tets at each vertex in one direction, to find regular vertices (for Section 5.1.2).
#include <atomic>
#include <bit>

#include <base/low_level.hpp>
#include <igm/regular_vertices.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex::igm {

namespace {

constexpr std::size_t kRegularVerticesGrain = RegularVertices::kBlock;

/// Tets whose parameters, 96 bytes each, are still in the innermost cache when they are visited
/// again.
constexpr std::size_t kPart = 128;

/// Faces between prefetching a tet and looking at it: the memory's latency, in iterations.
constexpr std::size_t kPrefetchDistance = 12;

/// The boundary planes at a vertex: bit k for those across axis k.
struct Planes {
  std::uint8_t all = 0;
  std::uint8_t below = 0;  ///< where the tet of some boundary face is on the smaller side

  [[nodiscard]] bool areMany() const noexcept { return hasManyBits(all); }
};

/// The axes along which a triangle is constant, as bits.
unsigned constantAxes(const Vec3& p, const Vec3& q, const Vec3& r) {
  unsigned axes = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double extent = std::abs(p[k] - q[k]) + std::abs(p[k] - r[k]);  // a single comparison
    axes |= (extent == 0 ? 1U : 0U) << k;
  }
  return axes;
}

/// Up to four entries per tet of a part, listed without branches: which ones belong there cannot be
/// predicted.
class PartList {
 public:
  void add(std::uint32_t entry, bool wanted) {
    entries_[count_] = entry;
    count_ += wanted ? 1 : 0;
  }
  [[nodiscard]] std::span<const std::uint32_t> get() const { return {entries_.data(), count_}; }

 private:
  std::array<std::uint32_t, 4 * kPart + 1> entries_;  // NOLINT: written before it is read
  std::size_t count_ = 0;
};

/// Calls f(begin, end) for the parts of a block.
template <class F>
void forEachPart(std::size_t begin, std::size_t end, const F& f) {
  for (; begin < end; begin += kPart) f(begin, std::min(begin + kPart, end));
}

RegularVertices::BoundaryFace boundaryFace(const LocalParameters& parameters,
                                           adjacency::HalfFace halfFace) {
  TetParameters scratch;  // NOLINT: written before it is read
  const TetParameters& u = parameters.see(adjacency::tetOf(halfFace), scratch);
  const std::array<int, 3>& corners = lattice::kFaceCorners[halfFace % 4];
  const Vec3& p = u[static_cast<std::size_t>(corners[0])];
  const Vec3& q = u[static_cast<std::size_t>(corners[1])];
  const Vec3& r = u[static_cast<std::size_t>(corners[2])];
  const unsigned constant = constantAxes(p, q, r);
  const std::size_t axis = hasOneBit(constant)
                               ? static_cast<std::size_t>(std::countr_zero(constant))
                               : dominantAxis(cross(minus(q, p), minus(r, p)));
  // The general direction, positive along all axes, leads inward if the tet is above.
  const bool isAbove = u[halfFace % 4][axis] > p[axis];
  return {halfFace, static_cast<std::uint16_t>(axis), static_cast<std::uint8_t>(constant), isAbove};
}

/// Goes through boundary faces, then through tets and inner faces.
class RegularVertexSearch {
 public:
  RegularVertexSearch(const adjacency::TetTopology& topology, const LocalParameters& parameters)
      : topology_(topology),
        parameters_(parameters),
        planes_(topology.pointCount),
        cones_(topology.pointCount, 0) {
    const std::size_t blocks = blockCount(topology.tetCount(), kRegularVerticesGrain);
    result_.isIrregular.assign(topology.pointCount, 0);
    result_.plane.resize(topology.pointCount);
    result_.sides.resize(topology.tetCount());
    result_.boundaryFaces.resize(blocks);
    result_.unequalFaces.resize(blocks);
  }

  RegularVertices run(Stage& stage) {
    const std::size_t tets = topology_.tetCount();
    parallelBlocks(stage, tets, kRegularVerticesGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     forEachPart(begin, end, [&](std::size_t first, std::size_t last) {
                       listBoundary(first, last, result_.boundaryFaces[block]);
                     });
                   });
    // On one thread, as faces share most of their corners, and are few.
    std::uint64_t boundaryFaces = 0;
    for (const auto& faces : result_.boundaryFaces) {
      boundaryFaces += faces.size();
      for (const RegularVertices::BoundaryFace& face : faces) notePlane(face);
    }
    result_.innerFaces = (4 * tets - boundaryFaces) / 2;
    parallelBlocks(stage, tets, kRegularVerticesGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     forEachPart(begin, end, [&](std::size_t first, std::size_t last) {
                       countCones(first, last);
                       compareNeighbours(first, last, result_.unequalFaces[block]);
                     });
                   });
    parallelFor(stage, topology_.pointCount, kRegularVerticesGrain, [&](std::size_t v) {
      result_.plane[v] = planes_[v].all;
      // On two planes, the cones were counted in vain.
      if ((cones_[v] != 1 || planes_[v].areMany()) &&
          !topology_.isIsolated(static_cast<Index>(v))) {
        result_.isIrregular[v] = 1;
      }
    });
    return std::move(result_);
  }

 private:
  void listBoundary(std::size_t begin, std::size_t end,
                    Array<RegularVertices::BoundaryFace>& faces) const {
    PartList list;
    for (auto h = static_cast<adjacency::HalfFace>(4 * begin); h < 4 * end; ++h) {
      list.add(h, topology_.isBoundary(h));
    }
    for (const adjacency::HalfFace h : list.get()) faces.push_back(boundaryFace(parameters_, h));
  }

  /// Notes the plane of a boundary face at its corners; without a plane, they are irregular.
  void notePlane(const RegularVertices::BoundaryFace& face) {
    if (face.constantAxes == 0) markFace(face.halfFace);
    for (const int corner : lattice::kFaceCorners[face.halfFace % 4]) {
      Planes& planes = planes_[vertexOf(face.halfFace, corner)];
      planes.all = static_cast<std::uint8_t>(planes.all | face.constantAxes);
      if (!face.isAbove) planes.below = static_cast<std::uint8_t>(planes.below | face.constantAxes);
    }
  }

  /// Counts tets at the vertices from which the general direction leads into them, and mirror
  /// images of tets at vertices on one boundary plane, unless the star is above that plane
  /// everywhere.
  void countCones(std::size_t begin, std::size_t end) {
    PartList cones;   // vertices
    PartList images;  // tets, and in the two lowest bits the axes along which they are mirrored
    for (auto t = static_cast<Index>(begin); t < end; t += 2) {
      const Index next = std::min(t + 1, static_cast<Index>(end - 1));
      const auto sides = sidesOf(t, kGeneralDirection, next, kGeneralDirection);
      listTet(t, sides[0], cones, images);
      if (next != t) listTet(next, sides[1], cones, images);
    }
    const std::span<const std::uint32_t> list = images.get();
    for (std::size_t i = 0; i < list.size(); i += 2) {
      const std::size_t next = std::min(i + 1, list.size() - 1);
      const auto sides = sidesOf(list[i] / 4, kRays[0][list[i] % 4].direction, list[next] / 4,
                                 kRays[0][list[next] % 4].direction);
      listImage(list[i], sides[0], cones);
      if (next != i) listImage(list[next], sides[1], cones);
    }
    for (const Index v : cones.get()) {
      std::atomic_ref(cones_[v]).fetch_add(1, std::memory_order_relaxed);
    }
  }

  void listTet(Index t, TetSides sides, PartList& cones, PartList& images) {
    const Tet& tet = topology_.tets[t];
    result_.sides[t] = sides;
    if (sides == kUncertainSides) {
      markTet(tet);
      return;
    }
    const std::size_t corner = coneCorner(sides);
    cones.add(tet[corner % 4], corner < 4);
    unsigned below = 0;
    for (const Index v : tet) below |= planes_[v].below;
    for (unsigned axis = 0; axis < 3; ++axis) images.add(4 * t + axis, (below >> axis & 1U) != 0);
  }

  void listImage(std::uint32_t image, TetSides sides, PartList& cones) {
    const Tet& tet = topology_.tets[image / 4];
    if (sides == kUncertainSides) {
      markTet(tet);  // the mirrored direction may be in a face
      return;
    }
    const std::size_t corner = coneCorner(sides);
    const Index vertex = tet[corner % 4];
    const Planes& planes = planes_[vertex];
    const unsigned plane = 1U << (image % 4);
    cones.add(vertex, allOf(corner < 4, planes.all == plane, planes.below == plane));
  }

  [[nodiscard]] std::array<TetSides, 2> sidesOf(Index t, const Vec3& direction, Index next,
                                                const Vec3& directionOfNext) const {
    std::array<TetParameters, 2> scratch;  // NOLINT: written before it is read
    return igm::sidesOf(parameters_.see(t, scratch[0]), direction,
                        parameters_.see(next, scratch[1]), directionOfNext);
  }

  /// Compares the parameters of at most kPart tets with those of neighbours, from the larger
  /// half-face: the other tet has then been visited not long ago.
  void compareNeighbours(std::size_t begin, std::size_t end, Array<adjacency::HalfFace>& unequal) {
    PartList inner;
    for (auto h = static_cast<adjacency::HalfFace>(4 * begin); h < 4 * end; ++h) {
      inner.add(h, topology_.mate[h] < h);
    }
    const std::span<const adjacency::HalfFace> faces = inner.get();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const std::size_t ahead = std::min(i + kPrefetchDistance, faces.size() - 1);
      parameters_.prefetch(adjacency::tetOf(topology_.mate[faces[ahead]]));
      if (haveSameBits(faces[i]) || agree(topology_, parameters_, faces[i])) continue;
      markFace(faces[i]);
      unequal.push_back(faces[i]);
    }
  }

  /// Whether the corners of an inner face are the same bits in both tets, as nearly always happens.
  /// If so, agree() holds, too; this is faster.
  [[nodiscard]] bool haveSameBits(adjacency::HalfFace halfFace) const {
    const adjacency::HalfFace mate = topology_.mate[halfFace];
    const TetParameters& u = parameters_.given(adjacency::tetOf(halfFace));
    const TetParameters& v = parameters_.given(adjacency::tetOf(mate));
    const auto& here =
        adjacency::kAscendingFaceCorners[topology_.order[adjacency::tetOf(halfFace)]][halfFace % 4];
    const auto& there =
        adjacency::kAscendingFaceCorners[topology_.order[adjacency::tetOf(mate)]][mate % 4];
    const auto bits = [](const double* x) { return bitsAs<PairMask>(loadPair(x)); };
    PairMask difference = {0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      // Two overlapping pairs cover all three coordinates.
      difference |= bits(&u[here[k]][0]) ^ bits(&v[there[k]][0]);
      difference |= bits(&u[here[k]][1]) ^ bits(&v[there[k]][1]);
    }
    return !parameters_.moved() && (difference[0] | difference[1]) == 0;
  }

  [[nodiscard]] Index vertexOf(adjacency::HalfFace halfFace, int corner) const noexcept {
    return topology_.tets[adjacency::tetOf(halfFace)][static_cast<std::size_t>(corner)];
  }
  /// Several threads may mark the same vertex.
  void mark(Index v) {
    std::atomic_ref(result_.isIrregular[v]).store(1, std::memory_order_relaxed);
  }
  void markTet(const Tet& tet) {
    for (const Index v : tet) mark(v);
  }
  void markFace(adjacency::HalfFace halfFace) {
    for (const int corner : lattice::kFaceCorners[halfFace % 4]) mark(vertexOf(halfFace, corner));
  }

  const adjacency::TetTopology& topology_;
  const LocalParameters& parameters_;
  Array<Planes> planes_;  ///< per vertex
  Array<Index> cones_;    ///< per vertex: tets in one fixed direction from it
  RegularVertices result_;
};

}  // namespace

RegularVertices findRegularVertices(const adjacency::TetTopology& topology,
                                    const LocalParameters& parameters, Stage& stage) {
  return RegularVertexSearch(topology, parameters).run(stage);
}

}  // namespace hexhex::igm
