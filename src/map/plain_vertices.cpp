#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

#include <base/branchless.hpp>
#include <base/vector3.hpp>
#include <map/plain_vertices.hpp>

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

/// Sets bits that several threads may set; nearly always, all are set already.
void addBits(std::uint8_t& bits, unsigned added) {
  const std::atomic_ref shared(bits);
  if ((shared.load(std::memory_order_relaxed) & added) == added) return;
  shared.fetch_or(static_cast<std::uint8_t>(added), std::memory_order_relaxed);
}

/// Per vertex: tets in one and the same direction from it.
using Cones = Array<std::uint32_t>;

/// The faces of a tet, as seen by the direction in general position.
class TetNormals {
 public:
  explicit TetNormals(const TetParameters& u) {
    const Vec3 a = minus(u[1], u[0]);
    const Vec3 b = minus(u[2], u[0]);
    const Vec3 c = minus(u[3], u[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      size_ = std::max(std::max(size_, std::abs(a[k])), std::max(std::abs(b[k]), std::abs(c[k])));
    }
    normals_ = {cross(b, c), cross(c, a), cross(a, b)};
    const double determinant = dot(a, normals_[0]);
    isPositive_ = allOf(size_ > 0x1p-300, determinant > 0x1p-46 * size_ * size_ * size_);
    for (std::size_t i = 0; i < 3; ++i) sides_[i] = dot(kGeneralDirection, normals_[i]);
  }

  /// As computeSides().
  [[nodiscard]] TetSides sides() const noexcept { return packed(sides_); }

  /// The same, with the direction mirrored along an axis.
  [[nodiscard]] TetSides mirrored(std::size_t axis) const noexcept {
    Vec3 sides = sides_;
    for (std::size_t i = 0; i < 3; ++i) {
      sides[i] -= 2 * kGeneralDirection[axis] * normals_[i][axis];
    }
    return packed(sides);
  }

 private:
  /// @param sides  of faces 1 to 3
  [[nodiscard]] TetSides packed(const Vec3& sides) const noexcept {
    const double side0 = -(sides[0] + sides[1] + sides[2]);
    // With u = 2^-53: differences carry one rounding, components of normals are below 2 size^2 and
    // off by 8 u size^2, the determinant by 42 u size^3, sides 1 to 3 by 33 u size^2, or 43 u
    // size^2 if mirrored, and side 0 by 171 u size^2. Below 2^-300, products could underflow.
    const double uncertainty = 0x1p-45 * size_ * size_;
    const double smallest = std::min(std::min(std::abs(side0), std::abs(sides[0])),
                                     std::min(std::abs(sides[1]), std::abs(sides[2])));
    if (!allOf(isPositive_, smallest > uncertainty)) return kUncertainSides;
    const unsigned outward = signBit(side0) | (signBit(sides[0]) << 1) | (signBit(sides[1]) << 2) |
                             (signBit(sides[2]) << 3);
    return static_cast<TetSides>(outward ^ kAllSides);
  }

  /// Inward, of the faces opposite corners 1, 2, 3; the four normals add up to zero.
  std::array<Vec3, 3> normals_{};
  static constexpr unsigned kAllSides = 15;
  Vec3 sides_{};  ///< scalar products of the direction with them
  double size_ = 0;
  bool isPositive_ = false;
};

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

/// The axes along which a triangle is constant, and the one across which it lies.
struct TrianglePlane {
  unsigned constantAxes = 0;  ///< bit k for axis k
  std::size_t axis = 0;       ///< the normal's largest component, at least nearly

  TrianglePlane(const LocalParameters& parameters, HalfFace halfFace) {
    const std::array<int, 3>& corners = kFaceCorners[halfFace % 4];
    const Vec3 p = parameters(tetOf(halfFace), corners[0]);
    const Vec3 a = minus(parameters(tetOf(halfFace), corners[1]), p);
    const Vec3 b = minus(parameters(tetOf(halfFace), corners[2]), p);
    // A difference is zero only if there is none.
    for (std::size_t k = 0; k < 3; ++k) {
      constantAxes |= (allOf(a[k] == 0, b[k] == 0) ? 1U : 0U) << k;
    }
    axis = dominantAxis(cross(a, b));
  }
};

/// Lists the boundary faces of some tets, and notes their planes at their corners; without a
/// plane, these are special.
void surveyBoundary(const TetTopology& topology, const LocalParameters& parameters,
                    std::size_t begin, std::size_t end, std::size_t block, PlainVertices& result) {
  BranchlessList list;
  for (auto h = static_cast<HalfFace>(4 * begin); h < 4 * end; ++h) {
    list.add(h, topology.mate[h] == kNone);
  }
  std::fill(&result.passages[4 * begin], &result.passages[4 * begin] + 4 * (end - begin),
            Passage());
  std::vector<PlainVertices::BoundaryFace>& faces = result.boundaryFaces[block];
  for (const HalfFace halfFace : list.get()) {
    const Tet& tet = topology.tets[tetOf(halfFace)];
    const TrianglePlane plane(parameters, halfFace);
    faces.push_back({halfFace, static_cast<std::uint32_t>(plane.axis)});
    result.passages[halfFace] =
        Passage::boundary(plane.axis, plane.constantAxes == 1U << plane.axis);
    if (plane.constantAxes == 0) markCorners(tet, localOf(halfFace), result);
    for (const int corner : kFaceCorners[halfFace % 4]) {
      addBits(result.plane[tet[static_cast<std::size_t>(corner)]], plane.constantAxes);
    }
  }
}

/// Finds out how the direction lies to tets, and counts cones: of the tets, and of their mirror
/// images at vertices that are on one boundary plane.
class TetSurvey {
 public:
  TetSurvey(const TetTopology& topology, const LocalParameters& parameters, Cones& cones,
            PlainVertices& result)
      : topology_(topology), parameters_(parameters), cones_(cones), result_(result) {}

  void run(Index t) {
    const Tet& tet = topology_.tets[t];
    TetParameters scratch;
    const TetNormals normals(parameters_.see(t, scratch));
    const TetSides sides = normals.sides();
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
    if (planes != 0) addMirrored(tet, normals, planes);
  }

  /// Adds up what run() has found, for at most kNear tets.
  void finish() {
    for (const Index vertex : found_.get()) {
      std::atomic_ref(cones_[vertex]).fetch_add(1, std::memory_order_relaxed);
    }
    found_.clear();
  }

 private:
  void addMirrored(const Tet& tet, const TetNormals& normals, unsigned planes) {
    for (unsigned rest = planes; rest != 0; rest &= rest - 1) {
      const auto axis = static_cast<std::size_t>(std::countr_zero(rest));
      const TetSides sides = normals.mirrored(axis);
      // The mirrored direction may be in a face of the tet.
      if (sides == kUncertainSides) {
        markAll(tet);
        continue;
      }
      // On two planes, a vertex is special anyway.
      const std::size_t corner = coneCorner(sides);
      const Index vertex = tet[corner % 4];
      found_.add(vertex, allOf(corner != 4, result_.plane[vertex] == 1U << axis));
    }
  }

  void markAll(const Tet& tet) {
    for (const Index v : tet) mark(result_.special[v]);
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  Cones& cones_;
  PlainVertices& result_;
  BranchlessList found_;  ///< vertices
};

/// Whether two tets agree on the parameters of the corners of their common face.
bool agree(const TetTopology& topology, const LocalParameters& parameters, HalfFace here,
           HalfFace there) {
  const SharedFace face(topology, here, there);
  for (std::size_t k = 0; k < 3; ++k) {
    if (parameters.at(tetOf(here), face.here(k)) != parameters.at(tetOf(there), face.there(k))) {
      return false;
    }
  }
  return true;
}

/// Whether they have the same bits there: the same as agree(), if true.
bool areSame(const TetTopology& topology, const LocalParameters& parameters, HalfFace here,
             HalfFace there) {
  const SharedFace face(topology, here, there);
  const TetParameters& u = parameters.given(tetOf(here));
  const TetParameters& v = parameters.given(tetOf(there));
  std::uint64_t difference = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& a = u[face.here(k)];
    const Vec3& b = v[face.there(k)];
    for (std::size_t i = 0; i < 3; ++i) {
      difference |= std::bit_cast<std::uint64_t>(a[i]) ^ std::bit_cast<std::uint64_t>(b[i]);
    }
  }
  return difference == 0;
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
  std::vector<HalfFace>& found = result.unequalFaces[block];
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

TetSides computeSides(const TetParameters& u) noexcept { return TetNormals(u).sides(); }

TetSides computeMirroredSides(const TetParameters& u, std::size_t axis) noexcept {
  return TetNormals(u).mirrored(axis);
}

PlainVertices findPlainVertices(const TetTopology& topology, const LocalParameters& parameters,
                                Stage& stage) {
  const std::size_t vertices = topology.pointCount;
  PlainVertices result;
  Array<std::uint8_t>& special = result.special;
  special.assign(vertices, 0);
  result.plane.assign(vertices, 0);
  Cones cones(vertices, 0);
  result.sides.resize(topology.tetCount());
  result.passages.resize(4 * topology.tetCount());
  const std::size_t tets = topology.tetCount();
  result.boundaryFaces.resize(blockCount(tets, kGrain));
  result.unequalFaces.resize(blockCount(tets, kGrain));
  parallelBlocks(stage, tets, kGrain, [&](std::size_t first, std::size_t last, std::size_t block) {
    forEachPart(first, last, [&](std::size_t begin, std::size_t end) {
      surveyBoundary(topology, parameters, begin, end, block, result);
    });
  });
  std::uint64_t boundaryFaces = 0;
  for (const auto& faces : result.boundaryFaces) boundaryFaces += faces.size();
  result.innerFaces = (4 * tets - boundaryFaces) / 2;
  parallelBlocks(stage, tets, kGrain, [&](std::size_t first, std::size_t last, std::size_t block) {
    TetSurvey tetSurvey(topology, parameters, cones, result);
    forEachPart(first, last, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) tetSurvey.run(static_cast<Index>(t));
      tetSurvey.finish();
      surveyFaces(topology, parameters, begin, end, block, result);
    });
  });
  parallelFor(stage, vertices, kGrain, [&](std::size_t v) {
    // On two planes, all cones are counted in vain.
    const bool manyPlanes = (result.plane[v] & (result.plane[v] - 1)) != 0;
    if ((cones[v] != 1 || manyPlanes) && !topology.isIsolated(static_cast<Index>(v))) {
      special[v] = 1;
    }
  });
  return result;
}

}  // namespace hexhex
