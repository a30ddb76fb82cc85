#include <algorithm>
#include <array>
#include <atomic>
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

/// Compares all corners with the first one of their vertex, and counts cones.
void surveyTets(const TetTopology& topology, const LocalParameters& parameters, Survey& survey,
                Array<std::uint8_t>& special, Stage& stage) {
  parallelFor(stage, topology.tetCount(), kGrain, [&](std::size_t t) {
    const Tet& tet = topology.tets[t];
    const TetParameters u = parameters(static_cast<Index>(t));
    for (std::size_t i = 0; i < 4; ++i) {
      if (u[i] != survey.parameter[tet[i]]) mark(survey.unequal[tet[i]]);
    }
    const ConeCorner corner = coneCorner(u);
    if (corner == ConeCorner::None) return;
    if (corner == ConeCorner::Uncertain) {
      for (const Index v : tet) mark(special[v]);
      return;
    }
    std::atomic_ref(survey.cones[tet[static_cast<std::size_t>(corner)]])
        .fetch_add(1, std::memory_order_relaxed);
  });
}

/// Whether two tets agree on the parameters of the corners that they share.
bool agree(const TetTopology& topology, const LocalParameters& parameters, HalfFace here,
           HalfFace there) {
  return std::all_of(kFaceCorners[here % 4].begin(), kFaceCorners[here % 4].end(), [&](int corner) {
    const Index vertex = topology.vertex(4 * tetOf(here) + static_cast<CornerIndex>(corner));
    return parameters(tetOf(here), corner) ==
           parameters(tetOf(there), topology.localCorner(tetOf(there), vertex));
  });
}

/// Looks at each face of a block of tets, from its smaller half-face.
class FaceSurvey {
 public:
  FaceSurvey(const TetTopology& topology, const LocalParameters& parameters, const Survey& survey,
             Array<std::uint8_t>& special, std::vector<HalfFace>& unequalFaces)
      : topology_(topology),
        parameters_(parameters),
        survey_(survey),
        special_(special),
        unequalFaces_(unequalFaces) {}

  void run(Index t) {
    const Tet& tet = topology_.tets[t];
    const bool anyUnequal = (survey_.unequal[tet[0]] | survey_.unequal[tet[1]] |
                             survey_.unequal[tet[2]] | survey_.unequal[tet[3]]) != 0;
    for (int face = 0; face < 4; ++face) {
      const HalfFace here = halfFaceOf(t, face);
      const HalfFace there = topology_.mate[here];
      if (there == kNone) {
        markCorners(tet, face);
      } else if (here < there) {
        ++innerFaces_;
        if (!anyUnequal || agree(topology_, parameters_, here, there)) continue;
        markCorners(tet, face);
        unequalFaces_.push_back(here);
      }
    }
  }

  [[nodiscard]] std::uint64_t innerFaces() const noexcept { return innerFaces_; }

 private:
  void markCorners(const Tet& tet, int face) {
    for (const int corner : kFaceCorners[static_cast<std::size_t>(face)]) {
      mark(special_[tet[static_cast<std::size_t>(corner)]]);
    }
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  const Survey& survey_;
  Array<std::uint8_t>& special_;
  std::vector<HalfFace>& unequalFaces_;
  std::uint64_t innerFaces_ = 0;
};

}  // namespace

ConeCorner coneCorner(const TetParameters& u) noexcept {
  const Vec3 a = minus(u[1], u[0]);
  const Vec3 b = minus(u[2], u[0]);
  const Vec3 c = minus(u[3], u[0]);
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    size = std::max({size, std::abs(a[k]), std::abs(b[k]), std::abs(c[k])});
  }
  // In general position with respect to all that maps are made of: powers of the plastic number.
  constexpr Vec3 kDirection = {1, 0.7548776662466927, 0.5698402909980532};
  // Inward normals of the faces opposite corners 1, 2, 3; the four normals add up to zero.
  const Vec3 normal1 = cross(b, c);
  const double determinant = dot(a, normal1);
  const double side1 = dot(kDirection, normal1);
  const double side2 = dot(kDirection, cross(c, a));
  const double side3 = dot(kDirection, cross(a, b));
  const double side0 = -(side1 + side2 + side3);
  // With u = 2^-53: differences carry one rounding, components of normals are below 2 size^2 and
  // off by 8 u size^2, the determinant by 42 u size^3, sides 1 to 3 by 33 u size^2 and side 0 by
  // 141 u size^2. Below 2^-300, products could underflow.
  const double uncertainty = 0x1p-45 * size * size;
  const double smallest =
      std::min({std::abs(side0), std::abs(side1), std::abs(side2), std::abs(side3)});
  if (!(size > 0x1p-300 && determinant > 0x1p-46 * size * size * size && smallest > uncertainty)) {
    return ConeCorner::Uncertain;
  }
  // Seen from corner i, the cone is bounded by the three other faces.
  const int negative =
      (side0 < 0 ? 1 : 0) + (side1 < 0 ? 1 : 0) + (side2 < 0 ? 1 : 0) + (side3 < 0 ? 1 : 0);
  if (negative != 1) return ConeCorner::None;
  return static_cast<ConeCorner>((side1 < 0 ? 1 : 0) + (side2 < 0 ? 2 : 0) + (side3 < 0 ? 3 : 0));
}

PlainVertices findPlainVertices(const TetTopology& topology, const LocalParameters& parameters,
                                Stage& stage) {
  const std::size_t vertices = topology.pointCount;
  PlainVertices result;
  Array<std::uint8_t>& special = result.special;
  special.resize(vertices);
  Survey survey;
  survey.parameter.resize(vertices);
  survey.unequal.resize(vertices);
  survey.cones.resize(vertices);
  parallelFor(stage, vertices, kGrain, [&](std::size_t i) {
    const auto v = static_cast<Index>(i);
    special[v] = 0;
    survey.unequal[v] = 0;
    survey.cones[v] = 0;
    if (topology.isIsolated(v)) return;
    const Index tet = topology.vertexTet[v];
    survey.parameter[v] = parameters(tet, topology.localCorner(tet, v));
  });
  surveyTets(topology, parameters, survey, special, stage);
  result.unequalFaces.resize(blockCount(topology.tetCount(), kGrain));
  std::atomic<std::uint64_t> innerFaces = 0;
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   FaceSurvey faces(topology, parameters, survey, special,
                                    result.unequalFaces[block]);
                   for (std::size_t t = begin; t < end; ++t) faces.run(static_cast<Index>(t));
                   innerFaces += faces.innerFaces();
                 });
  result.innerFaces = innerFaces;
  parallelFor(stage, vertices, kGrain, [&](std::size_t v) {
    if (survey.cones[v] != 1 && !topology.isIsolated(static_cast<Index>(v))) special[v] = 1;
  });
  return result;
}

}  // namespace hexhex
