// Sanitization (Section 5.1.3).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include <base/lanes.hpp>
#include <base/vector3.hpp>
#include <igm/map_conditions.hpp>
#include <igm/measures.hpp>
#include <igm/sanitization.hpp>

namespace hexhex::igm {

namespace {

constexpr std::size_t kExactMapGrain = 1024;

/// Lattice coordinates stay below 2^52 before scaling and below 2^60 after it, which the predicates
/// rely on (tet_geometry.hpp).
constexpr int kLatticeBits = 52;
constexpr int kScaledLatticeBits = 60;
/// Grid coordinates and translations between charts stay below 2^30 after scaling: they are 32-bit.
constexpr int kGridBits = 29;
/// With fewer fractional bits, rounding would move parameters noticeably.
constexpr int kMinFractionBits = 16;

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

/// The multiples to which coordinates are rounded. A table, as branches could not be predicted.
class Grains {
 public:
  explicit Grains(double unit) {
    for (lattice::AxisSet fixed = 0; fixed <= lattice::kAllAxes; ++fixed) {
      for (std::size_t k = 0; k < 3; ++k) {
        large_[fixed][k] = (fixed >> k & 1U) != 0 ? 0x1p52 * unit : 0x1p52;
      }
    }
  }
  /// 2^52 times the multiples in lattice units, per axis; 0 if a star decides.
  /// @param fixed  axes along which coordinates are to be integers, or a Rounding
  [[nodiscard]] const Vec3& at(lattice::AxisSet fixed) const noexcept { return large_[fixed]; }
  [[nodiscard]] const Vec3& at(Rounding rounding) const noexcept {
    return large_[static_cast<lattice::AxisSet>(rounding)];
  }

 private:
  std::array<Vec3, static_cast<std::size_t>(Rounding::ByStar) + 1> large_{};
};

/// The lattice point nearest to given parameters.
/// @param large  from Grains
lattice::LatticePoint nearestPoint(const Vec3& u, const Vec3& large, double unit) {
  const Pair xy = nearestMultiples(loadPair(&u[0]) * unit, loadPair(&large[0]));
  const Pair z = nearestMultiples(Pair{u[2], u[2]} * unit, Pair{large[2], large[2]});
  return {static_cast<std::int64_t>(xy[0]), static_cast<std::int64_t>(xy[1]),
          static_cast<std::int64_t>(z[0])};
}

/// What is rounded, onto which lattice, and where the results go.
struct Sanitization {
  const adjacency::TetTopology& topology;
  const LocalParameters& parameters;
  double tolerance;
  DefectCollector& defects;
  ExactMap& map;
  double unit = static_cast<double>(map.unit);
  Grains grains{unit};
};

/// Rounds corners at regular and flat vertices, each independently of the others.
class CornerRounder {
 public:
  explicit CornerRounder(const Sanitization& in) : in_(in) {}

  /// @param rounding  not by the star
  void run(adjacency::CornerIndex index, Rounding rounding) {
    const Vec3 u = in_.parameters(adjacency::tetOf(index), adjacency::localOf(index));
    lattice::LatticePoint& corner = in_.map.corners[index / 4][index % 4];
    corner = nearestPoint(u, in_.grains.at(rounding), in_.unit);
    const double displacement = displacementOf(u, corner, in_.unit);
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    if (displacement > in_.tolerance) report(index, rounding, displacement);
  }

  [[nodiscard]] double maxDisplacement() const noexcept { return maxDisplacement_; }

 private:
  void report(adjacency::CornerIndex index, Rounding rounding, double displacement) {
    const Index vertex = in_.topology.vertex(index);
    // The same at all corners of the vertex, and to be reported only once.
    if (in_.topology.vertexTet[vertex] != adjacency::tetOf(index)) return;
    in_.defects.add(
        rounding != Rounding::Free ? ErrorCode::BoundaryOffLattice : ErrorCode::TransitionResidual,
        {PlaceKind::Vertex, vertex}, displacement);
  }

  const Sanitization& in_;
  double maxDisplacement_ = 0;
};

/// Far more than in any star whose transitions do not contradict each other, and far less than what
/// could make another transition overflow.
bool outOfRange(const lattice::LatticePoint& value) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 58;
  return std::any_of(value.begin(), value.end(),
                     [](std::int64_t x) { return x > kLimit || x < -kLimit; });
}

/// Sets the corners of irregular vertices to what their stars demand, one vertex after the other.
class StarSanitizer {
 public:
  using Star = std::span<const VertexStar::Member>;

  StarSanitizer(const Sanitization& in, const Singularities& singularities)
      : in_(in), singularities_(singularities) {}

  /// @param planes  of the boundary faces, in the chart of the star's first member
  void run(Index v, Star star, lattice::AxisSet planes) {
    const adjacency::CornerIndex representative = star[0].corner;
    if (values_.size() <= star.size()) values_.resize(2 * star.size());
    values_[0] = nearestPoint(
        in_.parameters(adjacency::tetOf(representative), adjacency::localOf(representative)),
        in_.grains.at(fixedAxes(v, star, planes)), in_.unit);
    if (!spread(star)) {
      in_.defects.add(ErrorCode::HalfIntegerFixedPoint, {PlaceKind::Vertex, v}, 0);
    }
    double displacement = 0;
    for (std::size_t i = 0; i < star.size(); ++i) {
      const adjacency::CornerIndex corner = star[i].corner;
      in_.map.corners[corner / 4][corner % 4] = values_[i];
      const Vec3 before = in_.parameters(adjacency::tetOf(corner), adjacency::localOf(corner));
      displacement = std::max(displacement, displacementOf(before, values_[i], in_.unit));
    }
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    if (displacement > in_.tolerance) {
      in_.defects.add(causeOfDisplacement(v, planes), {PlaceKind::Vertex, v}, displacement);
    }
  }

  [[nodiscard]] double maxDisplacement() const noexcept { return maxDisplacement_; }

 private:
  /// All constraints of the star, in the chart of its first member, the representative.
  [[nodiscard]] lattice::AxisSet fixedAxes(Index v, Star star, lattice::AxisSet planes) const {
    tetmap::FixedAxes fixed(planes);
    for (const Index e : singularities_.at(v)) {
      const SingularEdge& edge = singularities_.edges[e];
      const auto member =
          std::find_if(star.begin(), star.end(),
                       [&edge](const VertexStar::Member& m) { return m.tet() == edge.tet; });
      fixed.addSingularEdge(static_cast<int>(edgeAxis(in_.parameters, edge)), member->rotation);
    }
    return fixed.axes();
  }

  /// Carries the value of the first member to all others, along the walk of VertexStar::collect();
  /// false if not all paths through the star lead to the same values.
  [[nodiscard]] bool spread(Star star) {
    std::int64_t difference = 0;
    std::size_t reached = 1;
    const auto cross = [&](std::size_t i, std::size_t k) {
      const VertexStar::Member& member = star[i];
      const lattice::LatticePoint image = carried(values_[i], member.halfFace(k));
      // At the boundary, a member is its own neighbour.
      const std::size_t behind = member.neighbour[k] == kNone ? i : member.neighbour[k];
      values_[reached] = image;  // wasted if the one behind is not new
      reached += behind == reached ? 1 : 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        difference |= values_[behind][axis] ^ image[axis];
      }
    };
    for (std::size_t k = 0; k < 3; ++k) cross(0, k);
    // Going through the entry would only carry the value back.
    for (std::size_t i = 1; i < star.size(); ++i) {
      cross(i, star[i].entry == 0 ? 1 : 0);
      cross(i, star[i].entry == 2 ? 1 : 2);
    }
    return difference == 0;
  }

  [[nodiscard]] lattice::LatticePoint carried(const lattice::LatticePoint& value,
                                              adjacency::HalfFace halfFace) const {
    if (!in_.map.transitions.isNonTrivial(halfFace)) return value;
    const lattice::LatticePoint image = in_.map.transitions.across(halfFace)(value, in_.map.unit);
    return outOfRange(image) ? value : image;
  }

  /// The condition violated by a vertex that had to move too far.
  [[nodiscard]] ErrorCode causeOfDisplacement(Index v, lattice::AxisSet planes) const {
    if (singularities_.degree(v) > 0) return ErrorCode::SingularityOffLattice;
    return planes != 0 ? ErrorCode::BoundaryOffLattice : ErrorCode::TransitionResidual;
  }

  const Sanitization& in_;
  const Singularities& singularities_;
  double maxDisplacement_ = 0;
  std::vector<lattice::LatticePoint> values_;  ///< per member of a star
};

void noteDisplacements(std::span<const double> displacements, ExactMap& map) {
  for (const double displacement : displacements) {
    map.maxDisplacement = std::max(map.maxDisplacement, displacement);
  }
}

/// The twelve coordinates of a tet, corner by corner.
using Coordinates = std::array<Pair, 6>;

Coordinates inARow(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {loadPair(&a[0]), Pair{a[2], b[0]}, loadPair(&b[1]),
          loadPair(&c[0]), Pair{c[2], d[0]}, loadPair(&d[1])};
}

Vec3 cornerOf(const Coordinates& coordinates, std::size_t corner) {
  const auto number = [&](std::size_t i) { return coordinates[i / 2][i % 2]; };
  return {number(3 * corner), number(3 * corner + 1), number(3 * corner + 2)};
}

/// Rounds one tet after the other, two coordinates at a time. (One at a time, extractions of
/// sphere_blocks_low take 7 % longer, and with a CornerRounder those of s17c_sphere_r0.1 8 %.)
class TetRounder {
 public:
  TetRounder(const Sanitization& in, std::span<const Rounding> rounding)
      : in_(in),
        rounding_(rounding),
        leastDeterminant_(leastCertainDeterminant(in.parameters, in.unit)) {}

  /// @return whether the tet is finished and certainly positive
  bool run(Index t) {
    TetParameters scratch;
    const TetParameters& u = in_.parameters.see(t, scratch);
    std::array<Rounding, 4> rounding{};
    for (std::size_t i = 0; i < 4; ++i) rounding[i] = rounding_[in_.topology.tets[t][i]];
    const Coordinates given = inARow(u[0], u[1], u[2], u[3]);
    const Coordinates large = inARow(in_.grains.at(rounding[0]), in_.grains.at(rounding[1]),
                                     in_.grains.at(rounding[2]), in_.grains.at(rounding[3]));
    const double resolution = 1 / in_.unit;
    Coordinates rounded;
    for (std::size_t i = 0; i < 6; ++i) {
      rounded[i] = nearestMultiples(given[i] * in_.unit, large[i]);
      displacement_ = larger(displacement_, magnitudeOf(rounded[i] * resolution - given[i]));
    }
    lattice::LatticeTet& corners = in_.map.corners[t];
    for (std::size_t i = 0; i < 12; ++i) {
      corners[i / 3][i % 3] = static_cast<std::int64_t>(rounded[i / 2][i % 2]);
    }
    return !isAnyByStar(rounding) && isPositive({cornerOf(rounded, 0), cornerOf(rounded, 1),
                                                 cornerOf(rounded, 2), cornerOf(rounded, 3)},
                                                leastDeterminant_);
  }

  /// Ignores corners that are decided by their stars.
  [[nodiscard]] double maxDisplacement() const {
    return std::max(displacement_[0], displacement_[1]);
  }

 private:
  static bool isAnyByStar(const std::array<Rounding, 4>& rounding) {
    unsigned bits = 0;
    for (const Rounding one : rounding) bits |= static_cast<unsigned>(one);
    return (bits & static_cast<unsigned>(Rounding::ByStar)) != 0;
  }

  const Sanitization& in_;
  std::span<const Rounding> rounding_;
  double leastDeterminant_;
  Pair displacement_ = {0, 0};
};

/// Rounds all corners; without effect on those that stars decide.
/// @return tets with such corners, and tets that are not certainly positive, in lists to be worked
///         on in parallel
std::vector<std::vector<Index>> roundTets(const Sanitization& in,
                                          std::span<const Rounding> rounding, Stage& stage) {
  const std::size_t tets = in.topology.tetCount();
  std::vector<std::vector<Index>> unfinished(blockCount(tets, kExactMapGrain));
  std::vector<double> displacements(unfinished.size());
  const auto report = [&](Index begin, Index end) {
    CornerRounder rounder(in);
    for (adjacency::CornerIndex corner = 4 * begin; corner < 4 * end; ++corner) {
      const Rounding how = rounding[in.topology.vertex(corner)];
      if (how != Rounding::ByStar) rounder.run(corner, how);
    }
  };
  parallelBlocks(stage, tets, kExactMapGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   TetRounder rounder(in, rounding);
                   std::array<Index, kExactMapGrain + 1> list;  // NOLINT: written before it is read
                   std::size_t count = 0;
                   for (auto t = static_cast<Index>(begin); t < end; ++t) {
                     list[count] = t;
                     count += rounder.run(t) ? 0 : 1;
                   }
                   unfinished[block].assign(list.begin(), list.begin() + count);
                   displacements[block] = rounder.maxDisplacement();
                   if (displacements[block] > in.tolerance) {
                     report(static_cast<Index>(begin), static_cast<Index>(end));
                   }
                 });
  noteDisplacements(displacements, in.map);
  return unfinished;
}

/// Sets corners to what the stars of their vertices demand.
void sanitizeStars(const Sanitization& in, std::span<const StarBlock> stars,
                   const Singularities& singularities, Stage& stage) {
  std::vector<double> displacements(stars.size());
  parallelFor(stage, stars.size(), 1, [&](std::size_t block) {
    StarSanitizer sanitizer(in, singularities);
    for (std::size_t i = 0; i < stars[block].vertices.size(); ++i) {
      sanitizer.run(stars[block].vertices[i], stars[block].star(i), stars[block].planes[i]);
    }
    CornerRounder rounder(in);
    for (const auto& [corner, rounding] : stars[block].planeCorners) rounder.run(corner, rounding);
    displacements[block] = std::max(sanitizer.maxDisplacement(), rounder.maxDisplacement());
  });
  noteDisplacements(displacements, in.map);
}

}  // namespace

double displacementOf(const Vec3& before, const lattice::LatticePoint& after,
                      double unit) noexcept {
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest = std::max(largest, std::abs(static_cast<double>(after[k]) / unit - before[k]));
  }
  return largest;
}

ExactMap sanitize(const adjacency::TetTopology& topology, const LocalParameters& parameters,
                  Transitions transitions, const RegularVertices& regular,
                  const VertexKinds& vertices, const Singularities& singularities, double tolerance,
                  int maxScale, Stage& stage, DefectCollector& defects) {
  ExactMap map;
  map.transitions = std::move(transitions);
  checkBoundary(regular, parameters, tolerance, stage, defects);
  checkSingularities(singularities, parameters, tolerance, defects);
  map.unit = std::int64_t{1} << fractionBits(parameters.largest(), maxScale, defects);
  if (defects.has(ErrorCode::TooLarge)) return map;
  map.corners.resize(topology.tetCount());
  const Sanitization sanitization{topology, parameters, tolerance, defects, map};
  const auto unfinished = roundTets(sanitization, vertices.rounding, stage);
  sanitizeStars(sanitization, vertices.blocks, singularities, stage);
  checkOrientations(unfinished, parameters, stage, defects, map);
  map.sixfoldVolume = sixfoldVolume(regular, map, stage);
  const auto unit = static_cast<double>(map.unit);
  const double cells = map.sixfoldVolume.toDouble() / (6 * unit * unit * unit);
  if (defects.empty() && cells >= kMaxCountedCells) defects.add(ErrorCode::TooLarge, {}, cells);
  return map;
}

void scaleMap(ExactMap& map, int scale, Stage& stage) {
  if (scale == 1) return;
  parallelFor(stage, map.corners.size(), kExactMapGrain, [&](std::size_t t) {
    for (lattice::LatticePoint& corner : map.corners[t]) {
      for (std::int64_t& coordinate : corner) coordinate *= scale;
    }
  });
  for (lattice::Transition& transition : map.transitions.table) {
    for (std::int32_t& component : transition.translation) component *= scale;
  }
  map.scale *= scale;
}

}  // namespace hexhex::igm
