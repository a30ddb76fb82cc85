#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <map/exact_map.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

/// Unscaled lattice coordinates stay below 2^52 and scaled ones below 2^60, which the predicates
/// rely on (tet_geometry.hpp).
constexpr int kLatticeBits = 52;
constexpr int kScaledLatticeBits = 60;
/// Grid coordinates and translations between charts stay below 2^30 after scaling: they are 32-bit.
constexpr int kGridBits = 29;
/// Fewer fractional bits than this would move parameters noticeably.
constexpr int kMinFractionBits = 16;

/// A set of coordinate axes: bit k for axis k.
using AxisSet = unsigned;
constexpr AxisSet kAllAxes = 7;

/// The axes that a rotation sends to these.
AxisSet rotatedBack(AxisSet axes, Rotation rotation) {
  AxisSet preimage = 0;
  for (int axis = 0; axis < 3; ++axis) {
    preimage |= ((axes >> axisOf(rotation(direction(axis, 1)))) & 1U) << axis;
  }
  return preimage;
}

/// By how much a coordinate changes at most.
/// @param resolution  1 / unit, exact
double displacementOf(const Vec3& before, const LatticePoint& after, double resolution) {
  double displacement = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    displacement =
        std::max(displacement, std::abs(static_cast<double>(after[k]) * resolution - before[k]));
  }
  return displacement;
}

/// What a vertex must fulfil, and its corners, while it is being sanitized. Reused between
/// vertices.
class VertexSanitizer {
 public:
  VertexSanitizer(const LocalParameters& parameters, const Singularities& singularities,
                  double tolerance, DefectCollector& defects, ExactMap& map)
      : parameters_(parameters),
        singularities_(singularities),
        tolerance_(tolerance),
        defects_(defects),
        map_(map),
        resolution_(1 / static_cast<double>(map.unit)) {}

  void run(Index v, std::span<const VertexStar::Member> star) {
    star_ = star;
    oneChart_ = !hasJump();
    if (!oneChart_) unfold();
    const LatticePoint value = snapped(fixedAxes(v));
    double displacement = 0;
    for (std::size_t i = 0; i < star_.size(); ++i) {
      displacement =
          std::max(displacement, assign(i, oneChart_ ? value : toStar_[i](value, map_.unit)));
    }
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    if (displacement > tolerance_) {
      defects_.add(causeOfDisplacement(v), {PlaceKind::Vertex, v}, displacement);
    }
    if (!oneChart_) checkLoops(v);
  }

  [[nodiscard]] double maxDisplacement() const noexcept { return maxDisplacement_; }

 private:
  /// Whether the star has a face at the vertex with a non-identity transition.
  [[nodiscard]] bool hasJump() const {
    Index any = 0;
    for (const VertexStar::Member& member : star_) {
      for (std::size_t k = 0; k < 3; ++k) any |= map_.transitions.jump[member.halfFace(k)];
    }
    return any != 0;
  }

  /// Transitions from the representative's chart, that of the first corner, into all others, along
  /// the walk through the star.
  void unfold() {
    toStar_.resize(star_.size());
    toStar_[0] = {};
    std::size_t reached = 1;
    for (std::size_t i = 0; i < star_.size(); ++i) {
      forEachNeighbour(i, [&](HalfFace halfFace, std::size_t neighbour) {
        if (neighbour != reached) return;
        ++reached;
        toStar_[neighbour] = map_.transitions.across(halfFace) * toStar_[i];
        // Only contradictory transitions lead out of range; checkLoops() will report them.
        if (outOfRange(toStar_[neighbour])) toStar_[neighbour] = {};
      });
    }
  }

  /// Local coordinates stay below 2^28, so transitions between them stay below 2^29, and sums of
  /// two of those fit 32 bits.
  [[nodiscard]] static bool outOfRange(const Transition& transition) {
    return std::any_of(transition.translation.begin(), transition.translation.end(),
                       [](std::int32_t t) { return std::abs(t) > (1 << 29); });
  }

  template <class Visit>
  void forEachNeighbour(std::size_t i, const Visit& visit) const {
    const VertexStar::Member& member = star_[i];
    for (std::size_t k = 0; k < 3; ++k) {
      if (member.neighbour[k] != kNone) visit(member.halfFace(k), member.neighbour[k]);
    }
  }

  /// All constraints of the star, in the representative's chart.
  [[nodiscard]] AxisSet fixedAxes(Index v) const {
    if (singularities_.isNode(v)) return kAllAxes;
    AxisSet fixed = 0;
    for (std::size_t i = 0; i < star_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (star_[i].neighbour[k] != kNone) continue;
        fixed |= inStar(1U << boundaryAxis(parameters_, star_[i].halfFace(k)), i);
      }
    }
    for (const Singularities::Incidence& incidence : singularities_.at(v)) {
      const SingularEdge& edge = singularities_.edges[incidence.edge];
      const AxisSet across = kAllAxes & ~(1U << edgeAxis(parameters_, edge));
      fixed |= inStar(across, memberOf(edge.tet));
    }
    return fixed;
  }

  [[nodiscard]] std::size_t memberOf(Index tet) const {
    const auto found =
        std::find_if(star_.begin(), star_.end(),
                     [tet](const VertexStar::Member& member) { return member.tet() == tet; });
    return static_cast<std::size_t>(found - star_.begin());
  }

  /// Axes of a member's chart in the representative's.
  [[nodiscard]] AxisSet inStar(AxisSet axes, std::size_t member) const {
    return oneChart_ ? axes : rotatedBack(axes, toStar_[member].rotation);
  }

  [[nodiscard]] LatticePoint snapped(AxisSet fixed) const {
    const Vec3 u = parameters_(tetOf(star_[0].corner), localOf(star_[0].corner));
    const auto unit = static_cast<double>(map_.unit);
    LatticePoint value{};
    for (std::size_t k = 0; k < 3; ++k) {
      value[k] = (fixed >> k) & 1U ? std::llrint(u[k]) * map_.unit : std::llrint(u[k] * unit);
    }
    return value;
  }

  /// Sets one corner; returns by how much it moves.
  double assign(std::size_t i, const LatticePoint& value) {
    const CornerIndex corner = star_[i].corner;
    map_.corners[corner / 4][corner % 4] = value;
    return displacementOf(parameters_(corner / 4, localOf(corner)), value, resolution_);
  }

  /// The condition that a vertex which had to move too far violates.
  [[nodiscard]] ErrorCode causeOfDisplacement(Index v) const {
    if (singularities_.degree[v] > 0) return ErrorCode::SingularityOffLattice;
    const bool boundary =
        std::any_of(star_.begin(), star_.end(), [](const VertexStar::Member& member) {
          return std::count(member.neighbour.begin(), member.neighbour.end(), kNone) > 0;
        });
    if (boundary) return ErrorCode::BoundaryOffLattice;
    return ErrorCode::TransitionResidual;
  }

  [[nodiscard]] const LatticePoint& cornerOf(std::size_t i) const {
    return map_.corners[tetOf(star_[i].corner)][star_[i].corner % 4];
  }

  /// The loops of the star must reproduce the value.
  void checkLoops(Index v) {
    for (std::size_t i = 0; i < star_.size(); ++i) {
      const LatticePoint& here = cornerOf(i);
      bool closed = true;
      forEachNeighbour(i, [&](HalfFace halfFace, std::size_t neighbour) {
        if (neighbour < i) return;  // done from the other side
        const LatticePoint& there = cornerOf(neighbour);
        const bool same = map_.transitions.isJump(halfFace)
                              ? map_.transitions.across(halfFace)(here, map_.unit) == there
                              : here == there;
        closed = closed && same;
      });
      if (!closed) {
        defects_.add(ErrorCode::HalfIntegerFixedPoint, {PlaceKind::Vertex, v}, 0);
        return;
      }
    }
  }

 public:
  /// The axis along which a boundary triangle is constant, or nearly so.
  static std::size_t boundaryAxis(const LocalParameters& parameters, HalfFace halfFace) {
    const std::array<int, 3>& face = kFaceCorners[halfFace % 4];
    const Vec3 p = parameters(tetOf(halfFace), face[0]);
    const Vec3 q = parameters(tetOf(halfFace), face[1]);
    const Vec3 r = parameters(tetOf(halfFace), face[2]);
    return dominantAxis(cross(minus(q, p), minus(r, p)));
  }

  /// The axis along which a singular edge runs, in the chart of its tet.
  static std::size_t edgeAxis(const LocalParameters& parameters, const SingularEdge& edge) {
    const Vec3 p = parameters(edge.tet, edge.corner0);
    const Vec3 q = parameters(edge.tet, edge.corner1);
    return dominantAxis(minus(q, p));
  }

 private:
  const LocalParameters& parameters_;
  const Singularities& singularities_;
  double tolerance_;
  DefectCollector& defects_;
  ExactMap& map_;
  double resolution_;
  double maxDisplacement_ = 0;
  std::span<const VertexStar::Member> star_;
  bool oneChart_ = true;            ///< then `toStar_` is not used
  std::vector<Transition> toStar_;  ///< from the representative's chart
};

/// (IGM2) up to the tolerance: what snapping may repair.
void checkBoundary(const PlainVertices& plain, const LocalParameters& parameters, double tolerance,
                   Stage& stage, DefectCollector& defects) {
  parallelFor(stage, plain.boundaryFaces.size(), 1, [&](std::size_t block) {
    for (const PlainVertices::BoundaryFace& face : plain.boundaryFaces[block]) {
      const std::size_t axis = face.axis;
      const HalfFace halfFace = face.halfFace;
      std::array<double, 3> x{};
      for (std::size_t k = 0; k < 3; ++k) {
        x[k] = parameters(tetOf(halfFace), kFaceCorners[halfFace % 4][k])[axis];
      }
      const double plane = nearestInteger((x[0] + x[1] + x[2]) / 3);
      const double off = std::max(std::max(std::abs(x[0] - plane), std::abs(x[1] - plane)),
                                  std::abs(x[2] - plane));
      if (off > tolerance) {
        defects.add(ErrorCode::BoundaryOffLattice, {PlaceKind::Face, tetOf(halfFace), halfFace % 4},
                    off);
      }
    }
  });
}

/// (IGM3) up to the tolerance, for edges; nodes are noticed when they are snapped.
void checkSingularities(const Singularities& singularities, const LocalParameters& parameters,
                        double tolerance, DefectCollector& defects) {
  for (const SingularEdge& edge : singularities.edges) {
    const std::size_t along = VertexSanitizer::edgeAxis(parameters, edge);
    const Vec3 p = parameters(edge.tet, edge.corner0);
    const Vec3 q = parameters(edge.tet, edge.corner1);
    double off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == along) continue;
      const double line = std::nearbyint((p[k] + q[k]) / 2);
      off = std::max({off, std::abs(p[k] - line), std::abs(q[k] - line)});
    }
    if (off > tolerance) {
      defects.add(ErrorCode::SingularityOffLattice, {PlaceKind::Edge, edge.vertex0, edge.vertex1},
                  off);
    }
  }
}

/// Number of fractional bits of the lattice: as many as the largest coordinate allows.
int fractionBits(double largest, int maxScale, DefectCollector& defects) {
  const int wholeBits = std::ilogb(largest + 1) + 1;  // largest + rounding < 2^wholeBits
  const int scaleBits = static_cast<int>(std::bit_width(static_cast<unsigned>(maxScale)));
  const int bits = std::min(kLatticeBits - wholeBits, kScaledLatticeBits - wholeBits - scaleBits);
  if (wholeBits + scaleBits > kGridBits || bits < kMinFractionBits) {
    defects.add(ErrorCode::TooLarge, {}, largest * maxScale);
    return 0;
  }
  return bits;
}

/// Rounds corners at plain vertices, and at others with flat stars.
class CornerRounder {
 public:
  CornerRounder(const TetTopology& topology, double tolerance, DefectCollector& defects,
                ExactMap& map)
      : topology_(topology),
        tolerance_(tolerance),
        defects_(defects),
        map_(map),
        unit_(static_cast<double>(map.unit)),
        resolution_(1 / unit_) {}

  /// @param plane  of the boundary: bit k across axis k, or 0
  void run(CornerIndex index, const Vec3& u, unsigned plane) {
    LatticePoint& corner = map_.corners[index / 4][index % 4];
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = static_cast<std::int64_t>(nearestInteger(u[k] * unit_));
    }
    if (plane != 0) {
      const auto axis = static_cast<std::size_t>(std::countr_zero(plane));
      corner[axis] = static_cast<std::int64_t>(nearestInteger(u[axis])) * map_.unit;
    }
    const double displacement = displacementOf(u, corner, resolution_);
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    // The same at all corners of the vertex, and to be reported once.
    const Index vertex = topology_.vertex(index);
    if (displacement > tolerance_ && topology_.vertexTet[vertex] == tetOf(index)) {
      defects_.add(plane != 0 ? ErrorCode::BoundaryOffLattice : ErrorCode::TransitionResidual,
                   {PlaceKind::Vertex, vertex}, displacement);
    }
  }

  [[nodiscard]] double maxDisplacement() const noexcept { return maxDisplacement_; }

 private:
  const TetTopology& topology_;
  double tolerance_;
  DefectCollector& defects_;
  ExactMap& map_;
  double unit_;
  double resolution_;
  double maxDisplacement_ = 0;
};

/// Where the coordinate across a boundary plane is among those of all corners.
struct Snap {
  std::uint8_t axis = 0;
  std::uint8_t perCorner = 0;
  std::uint8_t offset = 12;
};

/// By PlainVertices::plane: for one axis, or in vain.
constexpr std::array<Snap, 32> kSnaps = [] {
  std::array<Snap, 32> snaps{};
  for (std::uint8_t axis = 0; axis < 3; ++axis) snaps[std::size_t{1} << axis] = {axis, 3, axis};
  return snaps;
}();

/// Of corners that are decided by their stars, and of others.
constexpr std::array<double, 2> kWeights = {0, 1};

/// Rounds corners at plain vertices, and others in vain where a star decides; tets without such
/// corners are then finished.
class TetRounder {
 public:
  TetRounder(const TetTopology& topology, const LocalParameters& parameters,
             const PlainVertices& plain, double tolerance, DefectCollector& defects, ExactMap& map)
      : topology_(topology),
        parameters_(parameters),
        plain_(plain),
        tolerance_(tolerance),
        map_(map),
        unit_(static_cast<double>(map.unit)),
        resolution_(1 / unit_),
        rounder_(topology, tolerance, defects, map) {}

  /// Whether the tet is finished, and certainly positive.
  bool run(Index t) {
    const Tet& tet = topology_.tets[t];
    TetParameters scratch;
    const TetParameters& u = parameters_.see(t, scratch);
    Rounded rounded;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) rounded[3 * i + k] = nearestInteger(u[i][k] * unit_);
    }
    unsigned planes = 0;
    for (const Index v : tet) planes |= plain_.plane[v];
    if (planes != 0) snap(tet, u, rounded);
    store(rounded, map_.corners[t]);
    const double displacement =
        planes == 0 ? displacementOfAll(u, rounded) : displacementOfOthers(tet, u, rounded);
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    if (displacement > tolerance_) report(t, u);
    const auto corner = [&rounded](std::size_t i) {
      return Vec3{rounded[3 * i], rounded[3 * i + 1], rounded[3 * i + 2]};
    };
    const Vec3 origin = corner(0);
    const double volume = certainDeterminant(minus(corner(1), origin), minus(corner(2), origin),
                                             minus(corner(3), origin));
    return planes < PlainVertices::kPlaneOfStar && volume > 0;
  }

  [[nodiscard]] double maxDisplacement() const noexcept {
    return std::max(maxDisplacement_, rounder_.maxDisplacement());
  }

 private:
  /// Coordinates of all corners in units of the lattice, exact for integers below 2^53, and one
  /// entry for what is written in vain.
  using Rounded = std::array<double, 13>;

  static void store(const Rounded& rounded, LatticeTet& corners) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners[i][k] = static_cast<std::int64_t>(rounded[3 * i + k]);
      }
    }
  }

  /// Makes coordinates across boundary planes integers.
  void snap(const Tet& tet, const TetParameters& u, Rounded& rounded) const {
    for (std::size_t i = 0; i < 4; ++i) {
      const Snap& snap = kSnaps[plain_.plane[tet[i]]];
      rounded[i * snap.perCorner + snap.offset] = nearestInteger(u[i][snap.axis]) * unit_;
    }
  }

  [[nodiscard]] double displacementAt(std::size_t i, const TetParameters& u,
                                      const Rounded& rounded) const {
    double moved = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      moved = std::max(moved, std::abs(rounded[3 * i + k] * resolution_ - u[i][k]));
    }
    return moved;
  }

  [[nodiscard]] double displacementOfAll(const TetParameters& u, const Rounded& rounded) const {
    Pair moved = {0, 0};
    for (std::size_t i = 0; i < 4; i += 2) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Pair before = {u[i][k], u[i + 1][k]};
        const Pair after = {rounded[3 * i + k], rounded[3 * i + 3 + k]};
        moved = larger(moved, magnitudeOf(after * resolution_ - before));
      }
    }
    return std::max(moved[0], moved[1]);
  }

  /// Without corners that are decided by their stars.
  [[nodiscard]] double displacementOfOthers(const Tet& tet, const TetParameters& u,
                                            const Rounded& rounded) const {
    double displacement = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double weight = kWeights[isDecidedByStar(tet[i]) ? 0 : 1];
      displacement = std::max(displacement, displacementAt(i, u, rounded) * weight);
    }
    return displacement;
  }

  [[nodiscard]] bool isDecidedByStar(Index vertex) const {
    return plain_.plane[vertex] >= PlainVertices::kPlaneOfStar;
  }

  void report(Index t, const TetParameters& u) {
    const Tet& tet = topology_.tets[t];
    for (std::size_t i = 0; i < 4; ++i) {
      if (isDecidedByStar(tet[i])) continue;
      rounder_.run(4 * t + static_cast<CornerIndex>(i), u[i], plain_.plane[tet[i]]);
    }
  }

  const TetTopology& topology_;
  const LocalParameters& parameters_;
  const PlainVertices& plain_;
  double tolerance_;
  ExactMap& map_;
  double unit_;
  double resolution_;
  CornerRounder rounder_;
  double maxDisplacement_ = 0;
};

/// Rounds all tets, and lists those that are not finished then.
std::vector<std::vector<Index>> roundTets(const TetTopology& topology,
                                          const LocalParameters& parameters,
                                          const PlainVertices& plain, double tolerance,
                                          Stage& stage, DefectCollector& defects, ExactMap& map) {
  const std::size_t blocks = blockCount(topology.tetCount(), kGrain);
  std::vector<std::vector<Index>> unfinished(blocks);
  std::vector<double> displacements(blocks);
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   TetRounder rounder(topology, parameters, plain, tolerance, defects, map);
                   std::array<Index, kGrain + 1> list;  // NOLINT: written before it is read
                   std::size_t count = 0;
                   for (std::size_t t = begin; t < end; ++t) {
                     list[count] = static_cast<Index>(t);
                     count += rounder.run(static_cast<Index>(t)) ? 0 : 1;
                   }
                   unfinished[block].assign(list.begin(), list.begin() + count);
                   displacements[block] = rounder.maxDisplacement();
                 });
  for (const double displacement : displacements) {
    map.maxDisplacement = std::max(map.maxDisplacement, displacement);
  }
  return unfinished;
}

/// (IGM4) for the tets that were not finished by rounding.
void checkOrientations(std::span<const std::vector<Index>> tets, Stage& stage,
                       DefectCollector& defects, const ExactMap& map) {
  const auto unit = static_cast<double>(map.unit);
  parallelFor(stage, tets.size(), 1, [&](std::size_t block) {
    for (const Index t : tets[block]) {
      const LatticeTet& c = map.corners[t];
      if (orientation(c[0], c[1], c[2], c[3]) > 0) continue;
      const double amount =
          orientationDeterminant(c[0], c[1], c[2], c[3]).toDouble() / (6 * unit * unit * unit);
      defects.add(ErrorCode::FlippedTet, {PlaceKind::Tet, t}, amount < 0 ? -amount : 0.0);
    }
  });
}

/// The volume of a tet is the sum of those between its faces and the origin. They cancel at inner
/// faces, but for what the transition makes of it: if it is a translation by t after a rotation,
/// then the scalar product of t with the triangle's normal is left.
class VolumeSum {
 public:
  explicit VolumeSum(const ExactMap& map) : map_(map) {}

  void addBoundary(const PlainVertices::BoundaryFace& face) {
    const Triangle triangle = triangleOf(face.halfFace);
    // Outward normals are the negative ones.
    for (std::size_t k = 0; k < 3; ++k) {
      add(crossComponent(triangle.a, triangle.b, k), -triangle.origin[k]);
    }
  }

  void addInner(HalfFace halfFace) {
    const Transitions& transitions = map_.transitions;
    const Index back = Transitions::inverse(transitions.jump[halfFace]);
    const GridPoint& translation = transitions.table[back].translation;
    const Triangle triangle = triangleOf(halfFace);
    for (std::size_t k = 0; k < 3; ++k) {
      add(crossComponent(triangle.a, triangle.b, k), -translation[k] * map_.unit);
    }
  }

  [[nodiscard]] const Int192& get() const noexcept { return sum_; }

 private:
  struct Triangle {
    LatticePoint origin;
    LatticePoint a;  ///< from the origin to the second corner
    LatticePoint b;
  };
  [[nodiscard]] Triangle triangleOf(HalfFace halfFace) const {
    const LatticeTet& corners = map_.corners[tetOf(halfFace)];
    const std::array<int, 3>& face = kFaceCorners[halfFace % 4];
    const LatticePoint& origin = corners[static_cast<std::size_t>(face[0])];
    return {origin, corners[static_cast<std::size_t>(face[1])] - origin,
            corners[static_cast<std::size_t>(face[2])] - origin};
  }

  /// Adds a product. The sign of a factor is as good as random, and made positive without a branch.
  void add(Int128 a, std::int64_t b) {
    const std::int64_t sign = b >> 63;  // 0 or -1
    sum_.addProduct((a ^ sign) - sign, (b ^ sign) - sign);
  }

  const ExactMap& map_;
  Int192 sum_;
};

void addVolumes(const PlainVertices& plain, Stage& stage, ExactMap& map) {
  const std::size_t blocks = plain.boundaryFaces.size();
  std::vector<Int192> volumes(blocks);
  parallelFor(stage, blocks, 1, [&](std::size_t block) {
    VolumeSum sum(map);
    for (const PlainVertices::BoundaryFace& face : plain.boundaryFaces[block]) {
      sum.addBoundary(face);
    }
    for (const HalfFace halfFace : plain.unequalFaces[block]) sum.addInner(halfFace);
    volumes[block] = sum.get();
  });
  for (const Int192& volume : volumes) map.sixfoldVolume += volume;
}

}  // namespace

ExactMap sanitize(const TetTopology& topology, const LocalParameters& parameters,
                  Transitions transitions, const PlainVertices& plain,
                  std::span<const StarBlock> stars, const Singularities& singularities,
                  double tolerance, int maxScale, Stage& stage, DefectCollector& defects) {
  ExactMap map;
  map.transitions = std::move(transitions);
  checkBoundary(plain, parameters, tolerance, stage, defects);
  checkSingularities(singularities, parameters, tolerance, defects);
  map.unit = std::int64_t{1} << fractionBits(parameters.largest(), maxScale, defects);
  if (defects.has(ErrorCode::TooLarge)) return map;
  map.corners.resize(topology.tetCount());
  const std::vector<std::vector<Index>> unfinished =
      roundTets(topology, parameters, plain, tolerance, stage, defects, map);
  std::vector<double> displacements(stars.size());
  parallelFor(stage, stars.size(), 1, [&](std::size_t block) {
    VertexSanitizer sanitizer(parameters, singularities, tolerance, defects, map);
    for (std::size_t i = 0; i < stars[block].vertices.size(); ++i) {
      sanitizer.run(stars[block].vertices[i], stars[block].star(i));
    }
    CornerRounder rounder(topology, tolerance, defects, map);
    for (const auto& [corner, plane] : stars[block].planeCorners) {
      rounder.run(corner, parameters(tetOf(corner), localOf(corner)), plane);
    }
    displacements[block] = std::max(sanitizer.maxDisplacement(), rounder.maxDisplacement());
  });
  for (const double displacement : displacements) {
    map.maxDisplacement = std::max(map.maxDisplacement, displacement);
  }
  checkOrientations(unfinished, stage, defects, map);
  addVolumes(plain, stage, map);
  return map;
}

void scaleMap(ExactMap& map, int scale, Stage& stage) {
  if (scale == 1) return;
  parallelFor(stage, map.corners.size(), kGrain, [&](std::size_t t) {
    for (LatticePoint& corner : map.corners[t]) {
      for (std::int64_t& coordinate : corner) coordinate *= scale;
    }
  });
  for (Transition& transition : map.transitions.table) {
    for (std::int32_t& component : transition.translation) component *= scale;
  }
}

}  // namespace hexhex
