#include <algorithm>
#include <cmath>

#include <tetmap/freedom.hpp>

#include <base/vector3.hpp>
#include <repair/patch_problem.hpp>
#include <repair/valid_tets.hpp>

namespace hexhex::repairs {

namespace {

/// The edges at a vertex, among all edges of the patch.
template <class Visit>
void forEachEdgeAt(const Patch& patch, const PatchCharts& charts, const Visit& visit) {
  for (const PatchEdge& edge : charts.edges()) {
    for (const Index v : {edge.vertex0, edge.vertex1}) {
      const auto found = std::lower_bound(patch.vertices.begin(), patch.vertices.end(), v);
      if (found == patch.vertices.end() || *found != v) continue;
      visit(static_cast<std::size_t>(found - patch.vertices.begin()), edge);
    }
  }
}

/// Carries the first chart to all corners, and fixes what the boundary fixes.
tetmap::FixedAxes unfold(const std::vector<igm::VertexStar::Member>& star,
                         const PatchCharts& charts, PatchVertex& vertex) {
  const std::vector<lattice::Transition> fromFirst = igm::unfoldStar(
      star, [&charts](adjacency::HalfFace halfFace) { return charts.across(halfFace); });
  tetmap::FixedAxes fixed;
  for (std::size_t i = 0; i < star.size(); ++i) {
    vertex.corners.push_back({star[i].corner, fromFirst[i]});
    for (std::size_t k = 0; k < 3; ++k) {
      if (star[i].neighbour[k] != kNone) continue;
      vertex.boundary = true;
      fixed.addPlane(charts.boundaryAxis(star[i].halfFace(k)), fromFirst[i].rotation);
    }
  }
  return fixed;
}

constexpr std::size_t kNotInPatch = static_cast<std::size_t>(-1);

/// Tets with less than this fraction of their longest edge's cube as six times their volume in
/// space are no shape to aim at (0.7 for the regular tet).
constexpr double kThin = 0.02;

using Edges = std::array<Vec3, 3>;

double determinant(const Edges& e) { return tripleProduct(e[0], e[1], e[2]); }

Edges edgesInSpace(const TetMapView& map, Index tet, double magnification) {
  const Tet& t = map.tets[tet];
  Edges edges{};
  for (std::size_t i = 0; i < 3; ++i) {
    edges[i] = minus(map.points[t[i + 1]], map.points[t[0]]);
    for (double& x : edges[i]) x *= magnification;
  }
  return edges;
}

/// A power of two that scales the longest edge of a patch in space to about 1, so that no volume
/// underflows, however small the object is.
double magnificationOf(const TetMapView& map, const Patch& patch) {
  double longest = 0;
  for (const Index t : patch.tets) {
    for (const Vec3& edge : edgesInSpace(map, t, 1)) {
      for (const double x : edge) longest = std::max(longest, std::abs(x));
    }
  }
  return longest > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(longest), -1000, 1000)) : 1;
}

/// A regular tet with six times its volume as given.
Edges regularTet(double sixfoldVolume) {
  const double a = std::cbrt(sixfoldVolume * std::sqrt(2.0));
  return {Vec3{a, 0, 0}, Vec3{a / 2, a * std::sqrt(3.0) / 2, 0},
          Vec3{a / 2, a / std::sqrt(12.0), a * std::sqrt(2.0 / 3.0)}};
}

}  // namespace

std::vector<PatchVertex> findFreedom(const igm::LocalParameters& parameters, const Patch& patch,
                                     const PatchCharts& charts) {
  std::vector<PatchVertex> vertices(patch.vertices.size());
  std::vector<tetmap::FixedAxes> fixed;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    PatchVertex& vertex = vertices[i];
    vertex.vertex = patch.vertices[i];
    fixed.push_back(unfold(patch.stars[i], charts, vertex));
  }
  forEachEdgeAt(patch, charts, [&](std::size_t i, const PatchEdge& edge) {
    if (!edge.singular) return;
    PatchVertex& vertex = vertices[i];
    vertex.singular = true;
    const auto copy = std::find_if(
        vertex.corners.begin(), vertex.corners.end(),
        [&](const PatchVertex::Copy& c) { return adjacency::tetOf(c.corner) == edge.tet; });
    fixed[i].addSingularEdge(edge.axis, copy->fromFirst.rotation);
  });
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    PatchVertex& vertex = vertices[i];
    vertex.fixed = fixed[i].axes();
    const adjacency::CornerIndex first = vertex.corners.front().corner;
    vertex.parameter = parameters(adjacency::tetOf(first), adjacency::localOf(first));
    for (std::size_t k = 0; k < 3; ++k) {
      if (((vertex.fixed >> k) & 1U) == 0) continue;
      const double integer = std::nearbyint(vertex.parameter[k]);
      vertex.off = std::max(vertex.off, std::abs(vertex.parameter[k] - integer));
      vertex.parameter[k] = integer;
    }
  }
  return vertices;
}

PatchProblem::PatchProblem(const TetMapView& map, const adjacency::TetTopology& topology,
                           const igm::LocalParameters& parameters, const Patch& patch,
                           std::span<const PatchVertex> vertices)
    : map_(map),
      topology_(topology),
      parameters_(parameters),
      vertices_(vertices),
      magnification_(magnificationOf(map, patch)) {
  unknowns_.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const bool fixed = ((vertices[i].fixed >> k) & 1U) != 0;
      unknowns_[i][k] = fixed ? -1 : static_cast<int>(problem_.x.size());
      if (!fixed) problem_.x.push_back(vertices[i].parameter[k]);
    }
  }
  const double scale = parametricScale(patch);
  problem_.elements.reserve(patch.tets.size());
  for (const Index t : patch.tets) addTet(t, scale);
}

/// Parametric volume per volume in space, over the whole patch: flipped tets count as negative, so
/// the sum is that of the map as it should be.
double PatchProblem::parametricScale(const Patch& patch) const {
  double inMap = 0;
  double inSpace = 0;
  for (const Index t : patch.tets) {
    inMap += determinantOf(parameters_(t));
    inSpace += std::abs(determinant(edgesInSpace(map_, t, magnification_)));
  }
  // A patch that is entirely flipped, or flat in space, is hopeless; any scale will do.
  return inMap > 0 && inSpace > 0 ? inMap / inSpace : 1;
}

void PatchProblem::addTet(Index tet, double scale) {
  untangle::Element entry;
  for (int c = 0; c < 4; ++c) entry.corners[static_cast<std::size_t>(c)] = cornerOf(tet, c);
  Edges ideal = edgesInSpace(map_, tet, magnification_);
  const double stretch = std::cbrt(scale);
  double longest = 0;
  for (Vec3& edge : ideal) {
    for (double& x : edge) x *= stretch;
    longest = std::max(longest, length(edge));
  }
  const double det = determinant(ideal);
  if (!(det > kThin * longest * longest * longest)) {
    const double least = 1e-12;
    ideal = regularTet(std::max({std::abs(det), kThin * longest * longest * longest, least}));
  }
  entry.gradients = untangle::tetGradients(ideal);
  problem_.elements.push_back(entry);
}

std::size_t PatchProblem::patchVertexOf(Index vertex) const {
  const auto found = std::lower_bound(
      vertices_.begin(), vertices_.end(), vertex,
      [](const PatchVertex& candidate, Index wanted) { return candidate.vertex < wanted; });
  if (found == vertices_.end() || found->vertex != vertex) return kNotInPatch;
  return static_cast<std::size_t>(found - vertices_.begin());
}

untangle::Corner PatchProblem::cornerOf(Index tet, int corner) const {
  untangle::Corner result;
  const std::size_t i = patchVertexOf(topology_.tets[tet][static_cast<std::size_t>(corner)]);
  if (i == kNotInPatch) {
    result.constant = parameters_(tet, corner);
    return result;
  }
  const PatchVertex& vertex = vertices_[i];
  const auto copy =
      std::find_if(vertex.corners.begin(), vertex.corners.end(),
                   [&](const PatchVertex::Copy& c) { return adjacency::tetOf(c.corner) == tet; });
  for (int axis = 0; axis < 3; ++axis) {
    const lattice::Direction image = copy->fromFirst.rotation(lattice::direction(axis, 1));
    const auto own = static_cast<std::size_t>(lattice::axisOf(image));
    const auto k = static_cast<std::size_t>(axis);
    result.constant[own] = copy->fromFirst.translation[own];
    result.sign[own] = static_cast<std::int8_t>(lattice::signOf(image));
    result.unknown[own] = unknowns_[i][k];
    if (unknowns_[i][k] < 0) result.constant[own] += lattice::signOf(image) * vertex.parameter[k];
  }
  return result;
}

std::vector<LockedTet> PatchProblem::lockedTets(const Patch& patch) const {
  std::vector<LockedTet> locked;
  for (const Index t : patch.startTets) {
    std::array<untangle::Corner, 4> corners{};
    for (int c = 0; c < 4; ++c) corners[static_cast<std::size_t>(c)] = cornerOf(t, c);
    // Number of axes along which all corners of a simplex are bound to the same coordinate.
    const auto commonConstraints = [&](lattice::CornerMask simplex) {
      const untangle::Corner& first = corners[lattice::firstCorner(simplex)];
      int constraints = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        bool common = true;
        for (int c = 0; c < 4; ++c) {
          if (!lattice::contains(simplex, c)) continue;
          const untangle::Corner& corner = corners[static_cast<std::size_t>(c)];
          common = common && corner.unknown[k] < 0 && corner.constant[k] == first.constant[k];
        }
        constraints += common ? 1 : 0;
      }
      return constraints;
    };
    lattice::CornerMask found =
        commonConstraints(lattice::kWholeTet) > 0 ? lattice::kWholeTet : lattice::kNoSimplex;
    for (int f = 0; f < 4; ++f) {
      if (commonConstraints(lattice::faceMask(f)) >= 2) found = lattice::faceMask(f);
    }
    if (found != lattice::kNoSimplex) locked.push_back({t, found});
  }
  return locked;
}

Vec3 PatchProblem::parameterOf(std::size_t vertex, double quantum) const {
  Vec3 u = vertices_[vertex].parameter;
  for (std::size_t k = 0; k < 3; ++k) {
    const int unknown = unknowns_[vertex][k];
    if (unknown < 0) continue;
    u[k] = std::nearbyint(problem_.x[static_cast<std::size_t>(unknown)] / quantum) * quantum;
  }
  return u;
}

bool PatchProblem::mayMove(std::size_t vertex) const {
  const std::array<int, 3>& unknowns = unknowns_[vertex];
  return std::any_of(unknowns.begin(), unknowns.end(), [](int unknown) { return unknown >= 0; });
}

}  // namespace hexhex::repairs
