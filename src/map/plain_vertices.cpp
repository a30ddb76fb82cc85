#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

#include <base/vector3.hpp>
#include <map/plain_vertices.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = PlainVertices::kBlock;

/// Sets a flag that several threads may set.
void mark(std::uint8_t& flag) { std::atomic_ref(flag).store(1, std::memory_order_relaxed); }

/// What the passes gather about each vertex.
struct Survey {
  Array<Vec3> parameter;        ///< of the corner in the smallest tet
  Array<std::uint8_t> unequal;  ///< some corner has other parameters
  Array<std::uint32_t> cones;   ///< tets in one and the same direction from the vertex
};

/// The corner from which the direction leads into the tet, by bits 0 to 3 of its sides: it is the
/// one whose opposite face is the only one from which the direction leads outward. 4 if there is
/// none.
constexpr std::array<std::uint8_t, 16> kConeCorner = [] {
  std::array<std::uint8_t, 16> corners{};
  corners.fill(4);
  for (std::uint8_t corner = 0; corner < 4; ++corner) corners[faceMask(corner)] = corner;
  return corners;
}();

/// The faces of a tet, as seen by directions.
class TetNormals {
 public:
  explicit TetNormals(const TetParameters& u) {
    const Vec3 a = minus(u[1], u[0]);
    const Vec3 b = minus(u[2], u[0]);
    const Vec3 c = minus(u[3], u[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      size_ = std::max({size_, std::abs(a[k]), std::abs(b[k]), std::abs(c[k])});
    }
    normals_ = {cross(b, c), cross(c, a), cross(a, b)};
    const double determinant = dot(a, normals_[0]);
    isPositive_ = size_ > 0x1p-300 && determinant > 0x1p-46 * size_ * size_ * size_;
  }

  /// As computeSides().
  [[nodiscard]] TetSides sides(unsigned mirror) const noexcept {
    Vec3 direction = kGeneralDirection;
    for (std::size_t k = 0; k < 3; ++k) {
      if ((mirror >> k) & 1U) direction[k] = -direction[k];
    }
    const double side1 = dot(direction, normals_[0]);
    const double side2 = dot(direction, normals_[1]);
    const double side3 = dot(direction, normals_[2]);
    const double side0 = -(side1 + side2 + side3);
    // With u = 2^-53: differences carry one rounding, components of normals are below 2 size^2 and
    // off by 8 u size^2, the determinant by 42 u size^3, sides 1 to 3 by 33 u size^2 and side 0 by
    // 141 u size^2. Below 2^-300, products could underflow.
    const double uncertainty = 0x1p-45 * size_ * size_;
    const double smallest =
        std::min({std::abs(side0), std::abs(side1), std::abs(side2), std::abs(side3)});
    if (!(isPositive_ && smallest > uncertainty)) return kUncertainSides;
    return static_cast<TetSides>((side0 > 0 ? 1 : 0) + (side1 > 0 ? 2 : 0) + (side2 > 0 ? 4 : 0) +
                                 (side3 > 0 ? 8 : 0));
  }

 private:
  /// Inward, of the faces opposite corners 1, 2, 3; the four normals add up to zero.
  std::array<Vec3, 3> normals_{};
  double size_ = 0;
  bool isPositive_ = false;
};

/// Compares all corners with the first one of their vertex, and counts cones.
void surveyTets(const TetTopology& topology, const LocalParameters& parameters, Survey& survey,
                PlainVertices& result, Stage& stage) {
  parallelFor(stage, topology.tetCount(), kGrain, [&](std::size_t t) {
    const Tet& tet = topology.tets[t];
    const TetParameters u = parameters(static_cast<Index>(t));
    for (std::size_t i = 0; i < 4; ++i) {
      if (u[i] != survey.parameter[tet[i]]) mark(survey.unequal[tet[i]]);
    }
    const TetSides sides = TetNormals(u).sides(0);
    result.sides[t] = sides;
    if (sides == kUncertainSides) {
      for (const Index v : tet) mark(result.special[v]);
      return;
    }
    const std::size_t corner = kConeCorner[sides];
    if (corner == 4) return;
    std::atomic_ref(survey.cones[tet[corner]]).fetch_add(1, std::memory_order_relaxed);
  });
}

/// Whether two tets agree on the parameters of those corners of their common face where not all
/// tets do.
bool agree(const TetTopology& topology, const LocalParameters& parameters, HalfFace here,
           HalfFace there, CornerMask unequal) {
  const Tet& tet = topology.tets[tetOf(here)];
  for (CornerMask rest = unequal; rest != 0; rest = static_cast<CornerMask>(rest & (rest - 1))) {
    const std::size_t corner = firstCorner(rest);
    if (parameters(tetOf(here), static_cast<int>(corner)) !=
        parameters(tetOf(there), topology.localCorner(tetOf(there), tet[corner]))) {
      return false;
    }
  }
  return true;
}

/// Looks at each face of a block of tets, from its smaller half-face.
class FaceSurvey {
 public:
  FaceSurvey(const TetTopology& topology, const LocalParameters& parameters, const Survey& survey,
             PlainVertices& result, std::vector<HalfFace>& unequalFaces)
      : topology_(topology),
        parameters_(parameters),
        survey_(survey),
        result_(result),
        unequalFaces_(unequalFaces) {}

  void run(Index t) {
    const Tet& tet = topology_.tets[t];
    CornerMask unequal = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      unequal = static_cast<CornerMask>(unequal | (survey_.unequal[tet[i]] << i));
    }
    for (int face = 0; face < 4; ++face) {
      const HalfFace here = halfFaceOf(t, face);
      const HalfFace there = topology_.mate[here];
      if (there == kNone) {
        surveyBoundary(t, face);
      } else if (here < there) {
        ++innerFaces_;
        const auto inQuestion = static_cast<CornerMask>(unequal & faceMask(face));
        if (agree(topology_, parameters_, here, there, inQuestion)) continue;
        markCorners(tet, face);
        markDisagreement(here);
        markDisagreement(there);
        unequalFaces_.push_back(here);
      }
    }
  }

  [[nodiscard]] std::uint64_t innerFaces() const noexcept { return innerFaces_; }

 private:
  void markCorners(const Tet& tet, int face) {
    for (const int corner : kFaceCorners[static_cast<std::size_t>(face)]) {
      mark(result_.special[tet[static_cast<std::size_t>(corner)]]);
    }
  }

  /// Notes the plane of a boundary face at its corners; without one, they are special.
  void surveyBoundary(Index t, int face) {
    const unsigned plane = constantAxes(parameters_, halfFaceOf(t, face));
    if (plane == 0) markCorners(topology_.tets[t], face);
    for (const int corner : kFaceCorners[static_cast<std::size_t>(face)]) {
      std::uint8_t& planes = result_.plane[topology_.tets[t][static_cast<std::size_t>(corner)]];
      std::atomic_ref(planes).fetch_or(static_cast<std::uint8_t>(plane), std::memory_order_relaxed);
    }
  }

  void markDisagreement(HalfFace halfFace) {
    std::atomic_ref(result_.sides[tetOf(halfFace)])
        .fetch_or(static_cast<TetSides>(16U << localOf(halfFace)), std::memory_order_relaxed);
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  const Survey& survey_;
  PlainVertices& result_;
  std::vector<HalfFace>& unequalFaces_;
  std::uint64_t innerFaces_ = 0;
};

/// Counts the cones of mirrored tets at vertices that are on one boundary plane.
class MirrorSurvey {
 public:
  MirrorSurvey(const TetTopology& topology, const LocalParameters& parameters, Survey& survey,
               PlainVertices& result)
      : topology_(topology), parameters_(parameters), survey_(survey), result_(result) {}

  void run(Index t) {
    unsigned axes = 0;
    // On two planes, a vertex is special anyway.
    for (const Index v : topology_.tets[t]) {
      const unsigned planes = result_.plane[v];
      axes |= (planes & (planes - 1)) == 0 ? planes : 0U;
    }
    if (axes == 0) return;
    const TetNormals normals(parameters_(t));
    for (unsigned axis = 1; axis <= 4; axis *= 2) {
      if ((axes & axis) != 0) count(topology_.tets[t], axis, normals.sides(axis));
    }
  }

 private:
  void count(const Tet& tet, unsigned axis, TetSides sides) {
    if (sides == kUncertainSides) {
      for (const Index v : tet) mark(result_.special[v]);
      return;
    }
    const std::size_t corner = kConeCorner[sides];
    if (corner == 4 || result_.plane[tet[corner]] != axis) return;
    std::atomic_ref(survey_.cones[tet[corner]]).fetch_add(1, std::memory_order_relaxed);
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  Survey& survey_;
  PlainVertices& result_;
};

}  // namespace

unsigned constantAxes(const LocalParameters& parameters, HalfFace halfFace) noexcept {
  const std::array<int, 3>& corners = kFaceCorners[halfFace % 4];
  const Vec3 p = parameters(tetOf(halfFace), corners[0]);
  const Vec3 q = parameters(tetOf(halfFace), corners[1]);
  const Vec3 r = parameters(tetOf(halfFace), corners[2]);
  unsigned axes = 0;
  for (std::size_t k = 0; k < 3; ++k) axes |= (p[k] == q[k] && p[k] == r[k] ? 1U : 0U) << k;
  return axes;
}

TetSides computeSides(const TetParameters& u, unsigned mirror) noexcept {
  return TetNormals(u).sides(mirror);
}

PlainVertices findPlainVertices(const TetTopology& topology, const LocalParameters& parameters,
                                Stage& stage) {
  const std::size_t vertices = topology.pointCount;
  PlainVertices result;
  Array<std::uint8_t>& special = result.special;
  special.resize(vertices);
  result.plane.resize(vertices);
  Survey survey;
  survey.parameter.resize(vertices);
  survey.unequal.resize(vertices);
  survey.cones.resize(vertices);
  parallelFor(stage, vertices, kGrain, [&](std::size_t i) {
    const auto v = static_cast<Index>(i);
    special[v] = 0;
    result.plane[v] = 0;
    survey.unequal[v] = 0;
    survey.cones[v] = 0;
    if (topology.isIsolated(v)) return;
    const Index tet = topology.vertexTet[v];
    survey.parameter[v] = parameters(tet, topology.localCorner(tet, v));
  });
  result.sides.resize(topology.tetCount());
  surveyTets(topology, parameters, survey, result, stage);
  result.unequalFaces.resize(blockCount(topology.tetCount(), kGrain));
  std::atomic<std::uint64_t> innerFaces = 0;
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   FaceSurvey faces(topology, parameters, survey, result,
                                    result.unequalFaces[block]);
                   for (std::size_t t = begin; t < end; ++t) faces.run(static_cast<Index>(t));
                   innerFaces += faces.innerFaces();
                 });
  result.innerFaces = innerFaces;
  MirrorSurvey mirror(topology, parameters, survey, result);
  parallelFor(stage, topology.tetCount(), kGrain,
              [&](std::size_t t) { mirror.run(static_cast<Index>(t)); });
  parallelFor(stage, vertices, kGrain, [&](std::size_t v) {
    // On two planes, all cones are counted in vain.
    const bool manyPlanes = (result.plane[v] & (result.plane[v] - 1)) != 0;
    if ((survey.cones[v] != 1 || manyPlanes) && !topology.isIsolated(static_cast<Index>(v))) {
      special[v] = 1;
    }
  });
  return result;
}

}  // namespace hexhex
