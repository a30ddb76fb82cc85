#include <algorithm>
#include <cmath>

#include <base/vector3.hpp>
#include <igm/map_conditions.hpp>
#include <igm/tet_rounder.hpp>
#include <igm/vertex_sanitizer.hpp>

namespace hexhex {

namespace {

/// Far more than in any star whose transitions do not contradict each other, and far less than what
/// another transition could make an overflow.
bool outOfRange(const LatticePoint& value) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 58;
  return std::any_of(value.begin(), value.end(),
                     [](std::int64_t x) { return x > kLimit || x < -kLimit; });
}

}  // namespace

void VertexSanitizer::run(Index v, std::span<const VertexStar::Member> star, unsigned planes) {
  if (values_.size() <= star.size()) values_.resize(2 * star.size());
  values_[0] = snapped(star[0].corner, fixedAxes(v, star, planes));
  const bool isClosed = spread(star);
  double displacement = 0;
  for (std::size_t i = 0; i < star.size(); ++i) {
    displacement = std::max(displacement, assign(star[i].corner, values_[i]));
  }
  maxDisplacement_ = std::max(maxDisplacement_, displacement);
  if (displacement > tolerance_) {
    defects_.add(causeOfDisplacement(v, planes), {PlaceKind::Vertex, v}, displacement);
  }
  if (!isClosed) defects_.add(ErrorCode::HalfIntegerFixedPoint, {PlaceKind::Vertex, v}, 0);
}

/// All constraints of the star, in the chart of its first member, the representative.
AxisSet VertexSanitizer::fixedAxes(Index v, std::span<const VertexStar::Member> star,
                                   AxisSet planes) const {
  if (singularities_.isNode(v)) return kAllAxes;
  AxisSet fixed = planes;
  for (const Index e : singularities_.at(v)) {
    const SingularEdge& edge = singularities_.edges[e];
    const AxisSet across = kAllAxes & ~(1U << edgeAxis(parameters_, edge));
    const auto member =
        std::find_if(star.begin(), star.end(),
                     [&edge](const VertexStar::Member& m) { return m.tet() == edge.tet; });
    fixed |= imageOf(across, member->rotation.inverse());
  }
  return fixed;
}

/// The corner of the representative: integers on fixed axes, elsewhere on the lattice.
LatticePoint VertexSanitizer::snapped(CornerIndex corner, AxisSet fixed) const {
  const Vec3 u = parameters_(tetOf(corner), localOf(corner));
  const auto unit = static_cast<double>(map_.unit);
  LatticePoint value{};
  for (std::size_t k = 0; k < 3; ++k) {
    const bool isFixed = ((fixed >> k) & 1U) != 0;
    value[k] = static_cast<std::int64_t>(isFixed ? nearestInteger(u[k]) * unit
                                                 : nearestInteger(u[k] * unit));
  }
  return value;
}

/// Carries the value of the first member to all others, along the walk; false if not all paths
/// through the star lead to the same values.
bool VertexSanitizer::spread(std::span<const VertexStar::Member> star) {
  std::size_t reached = 1;
  std::int64_t difference = 0;
  const auto pass = [&](std::size_t i, std::size_t k) {
    const VertexStar::Member& member = star[i];
    const LatticePoint value = values_[i];
    const Index index = map_.transitions.ofFace[member.halfFace(k)];
    const LatticePoint image = index == 0 ? value : carried(value, index);
    // At the boundary, a member stands for its neighbour.
    const std::size_t behind = member.neighbour[k] == kNone ? i : member.neighbour[k];
    values_[reached] = image;  // in vain if the one behind is not new
    reached += behind == reached ? 1 : 0;
    const LatticePoint& there = values_[behind];
    for (std::size_t axis = 0; axis < 3; ++axis) difference |= there[axis] ^ image[axis];
  };
  for (std::size_t k = 0; k < 3; ++k) pass(0, k);
  // The others hold what came through their entry, and would carry it back.
  for (std::size_t i = 1; i < star.size(); ++i) {
    const std::size_t entry = star[i].entry;
    pass(i, entry == 0 ? 1 : 0);
    pass(i, entry == 2 ? 1 : 2);
  }
  return difference == 0;
}

LatticePoint VertexSanitizer::carried(const LatticePoint& value, Index transition) const {
  const LatticePoint image = map_.transitions.table[transition](value, map_.unit);
  return outOfRange(image) ? value : image;
}

/// Sets one corner; returns by how much it moves.
double VertexSanitizer::assign(CornerIndex corner, const LatticePoint& value) {
  map_.corners[corner / 4][corner % 4] = value;
  const Vec3 rounded = {static_cast<double>(value[0]), static_cast<double>(value[1]),
                        static_cast<double>(value[2])};
  return displacementOf(parameters_(corner / 4, localOf(corner)), rounded, resolution_);
}

/// The condition that a vertex which had to move too far violates.
ErrorCode VertexSanitizer::causeOfDisplacement(Index v, AxisSet planes) const {
  if (singularities_.degree(v) > 0) return ErrorCode::SingularityOffLattice;
  return planes != 0 ? ErrorCode::BoundaryOffLattice : ErrorCode::TransitionResidual;
}

}  // namespace hexhex
