#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <adjacency/edge_fan.hpp>

#include <base/vector3.hpp>
#include <repair/patch_charts.hpp>
#include <repair/valid_tets.hpp>

namespace hexhex::repairs {

namespace {

/// Cost of an edge under a choice. An impossible edge outweighs any number of singular ones around
/// one defect; singular edges with two hexahedra too few or too many are rare.
constexpr double kSingular = 1;
constexpr double kHalfTurn = 2.5;
constexpr double kImpossible = 100;
/// Breaks ties in favour of the choice that fits best.
constexpr double kPerChoice = 1e-4;

bool isHalfTurn(lattice::Rotation rotation) { return (rotation * rotation).isIdentity(); }

/// Whether a vector is parallel to an axis, or too short to tell.
bool isAlong(const Vec3& v, int axis, double tolerance) {
  for (int k = 0; k < 3; ++k) {
    if (k != axis && std::abs(v[static_cast<std::size_t>(k)]) > 2 * tolerance) return false;
  }
  return true;
}

/// The angle of a tet at the edge between two of its corners: negative if the tet is flipped.
double angleInMap(const TetParameters& u, int corner0, int corner1) {
  const double angle =
      dihedralAngle(u, static_cast<std::size_t>(corner0), static_cast<std::size_t>(corner1));
  return determinantOf(u) < 0 ? -angle : angle;
}

}  // namespace

PatchCharts::PatchCharts(const TetMapView& map, const adjacency::TetTopology& topology,
                         const igm::LocalParameters& parameters, const Patch& patch,
                         double tolerance)
    : map_(map), topology_(topology), parameters_(parameters), tolerance_(tolerance) {
  collectFaces(patch);
  findCandidates();
  collectEdges(patch);
  resolve();
  classify();
}

void PatchCharts::collectFaces(const Patch& patch) {
  std::vector<adjacency::HalfFace> halfFaces;
  for (const std::vector<igm::VertexStar::Member>& star : patch.stars) {
    for (const igm::VertexStar::Member& member : star) {
      for (std::size_t k = 0; k < 3; ++k) {
        const adjacency::HalfFace halfFace = member.halfFace(k);
        const adjacency::HalfFace mate = topology_.mate[halfFace];
        halfFaces.push_back(mate == kNone ? halfFace : std::min(halfFace, mate));
      }
    }
  }
  sortUnique(halfFaces);
  faces_.reserve(halfFaces.size());
  for (const adjacency::HalfFace halfFace : halfFaces) {
    faces_.push_back({halfFace, topology_.isBoundary(halfFace), {}, {}, 0, {}});
  }
}

std::size_t PatchCharts::faceIndex(adjacency::HalfFace halfFace) const {
  const auto found = std::lower_bound(
      faces_.begin(), faces_.end(), halfFace,
      [](const Face& face, adjacency::HalfFace wanted) { return face.halfFace < wanted; });
  return static_cast<std::size_t>(found - faces_.begin());
}

void PatchCharts::findCandidates() {
  // How well rotations fit where nothing is wrong: this is the accuracy of the map.
  double noise = 1e-9;
  std::vector<std::vector<igm::FittedTransition>> fits(faces_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].boundary) continue;
    const adjacency::HalfFace halfFace = faces_[f].halfFace;
    fits[f] = fitsOf(halfFace);
    const bool healthy = !isBad(parameters_(adjacency::tetOf(halfFace))) &&
                         !isBad(parameters_(adjacency::tetOf(topology_.mate[halfFace])));
    if (healthy) noise = std::max(noise, fits[f].front().residual);
  }
  fitLimit_ = std::min(2 * noise, tolerance_);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    Face& face = faces_[f];
    if (face.boundary) {
      face.axes = planesOf(face.halfFace);
    } else {
      const double limit = std::max(fitLimit_, 2 * fits[f].front().residual);
      for (const igm::FittedTransition& fit : fits[f]) {
        if (fit.residual <= limit) face.candidates.push_back(fit.transition);
      }
    }
    if (face.choices() > 1) ambiguous_.push_back(static_cast<std::uint32_t>(f));
  }
}

/// All rotations, or only the one that the caller knows.
std::vector<igm::FittedTransition> PatchCharts::fitsOf(adjacency::HalfFace halfFace) const {
  const igm::SharedTriangle triangle(topology_, parameters_, halfFace);
  const auto known = igm::knownRotation(map_.rotations, halfFace);
  if (known) return {igm::fitTransition(triangle, *known)};
  return igm::fitAllTransitions(triangle);
}

/// The axes to which a boundary triangle may be perpendicular: one, unless it is flat.
std::vector<int> PatchCharts::planesOf(adjacency::HalfFace halfFace) const {
  const std::array<int, 3>& corners = lattice::kFaceCorners[halfFace % 4];
  std::array<Vec3, 3> u{};
  for (std::size_t k = 0; k < 3; ++k) u[k] = parameters_(adjacency::tetOf(halfFace), corners[k]);
  const Vec3 a = minus(u[1], u[0]);
  const Vec3 b = minus(u[2], u[0]);
  const Vec3 normal = cross(a, b);
  const double size = std::max({length(a), length(b), length(minus(b, a))});
  std::vector<int> axes;
  if (length(normal) <= (1e-9 * size + 2 * fitLimit_) * size) {
    // Any integer plane that contains all three corners.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double plane = std::nearbyint(u[0][axis]);
      const bool inPlane = std::all_of(u.begin(), u.end(), [&](const Vec3& corner) {
        return std::abs(corner[axis] - plane) <= tolerance_;
      });
      if (inPlane) axes.push_back(static_cast<int>(axis));
    }
  }
  if (axes.empty()) axes.push_back(static_cast<int>(dominantAxis(normal)));
  return axes;
}

void PatchCharts::collectEdges(const Patch& patch) {
  for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
    const Index v = patch.vertices[i];
    for (const igm::VertexStar::Member& member : patch.stars[i]) {
      for (const std::uint8_t c : igm::kOthers[member.corner % 4]) {
        const Index w = topology_.tets[member.tet()][c];
        PatchEdge edge;
        edge.vertex0 = std::min(v, w);
        edge.vertex1 = std::max(v, w);
        edge.tet = member.tet();
        edges_.push_back(edge);
      }
    }
  }
  const auto key = [](const PatchEdge& e) { return std::pair(e.vertex0, e.vertex1); };
  std::stable_sort(edges_.begin(), edges_.end(),
                   [&](const PatchEdge& a, const PatchEdge& b) { return key(a) < key(b); });
  edges_.erase(
      std::unique(edges_.begin(), edges_.end(),
                  [&](const PatchEdge& a, const PatchEdge& b) { return key(a) == key(b); }),
      edges_.end());
  fans_.resize(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    walkFan(edges_[e], fans_[e]);
    const auto list = [&](std::uint32_t face) {
      std::vector<std::uint32_t>& at = faces_[face].edges;
      if (at.empty() || at.back() != e) at.push_back(static_cast<std::uint32_t>(e));
    };
    for (const FanStep& step : fans_[e].steps) list(step.face);
    if (edges_[e].boundary) {
      list(fans_[e].firstBoundary);
      list(fans_[e].lastBoundary);
    }
  }
}

void PatchCharts::walkFan(PatchEdge& edge, Fan& fan) const {
  const lattice::CornerMask ends = topology_.edge(edge.tet, edge.vertex0, edge.vertex1).mask();
  adjacency::EdgeTurn back(topology_, edge.tet, ends, adjacency::otherFaceAtEdge(ends, -1));
  edge.boundary = back.goToBoundary();
  if (edge.boundary) {
    edge.tet = back.tet();
    fan.firstBoundary = static_cast<std::uint32_t>(faceIndex(back.out()));
  }
  fan.vector = minus(parameters_(edge.tet, topology_.localCorner(edge.tet, edge.vertex1)),
                     parameters_(edge.tet, topology_.localCorner(edge.tet, edge.vertex0)));
  edge.sound = true;
  adjacency::EdgeTurn turn(topology_, edge.tet, back.edge(),
                           adjacency::otherFaceAtEdge(back.edge(), adjacency::localOf(back.out())));
  do {
    if (isThin(parameters_(turn.tet()), fitLimit_)) edge.sound = false;
    const adjacency::HalfFace leaving = turn.out();
    const adjacency::HalfFace mate = turn.next();
    if (mate == kNone) {
      fan.lastBoundary = static_cast<std::uint32_t>(faceIndex(leaving));
      return;
    }
    fan.steps.push_back(
        {static_cast<std::uint32_t>(faceIndex(std::min(leaving, mate))), leaving < mate});
    turn.step();
  } while (turn.tet() != edge.tet);
}

lattice::Transition PatchCharts::across(adjacency::HalfFace halfFace) const {
  const adjacency::HalfFace mate = topology_.mate[halfFace];
  const Face& face = faces_[faceIndex(std::min(halfFace, mate))];
  const lattice::Transition& transition = face.candidates[face.chosen];
  return halfFace < mate ? transition : transition.inverse();
}

int PatchCharts::boundaryAxis(adjacency::HalfFace halfFace) const {
  const Face& face = faces_[faceIndex(halfFace)];
  return face.axes[face.chosen];
}

/// The holonomy of a whole fan: back to the first tet's chart, or on the boundary from the first to
/// the last.
lattice::Rotation PatchCharts::holonomy(const Fan& fan) const {
  lattice::Rotation total;
  for (const FanStep& step : fan.steps) {
    const Face& face = faces_[step.face];
    const lattice::Rotation rotation = face.candidates[face.chosen].rotation;
    total = (step.forward ? rotation : rotation.inverse()) * total;
  }
  return total;
}

/// The axes across the first and the last boundary face of a fan, both in the chart of its first
/// tet.
std::pair<int, int> PatchCharts::planesAt(const Fan& fan) const {
  const Face& first = faces_[fan.firstBoundary];
  const Face& last = faces_[fan.lastBoundary];
  const lattice::Direction normal = lattice::direction(last.axes[last.chosen], 1);
  return {first.axes[first.chosen], lattice::axisOf(holonomy(fan).inverse()(normal))};
}

double PatchCharts::edgeCost(std::size_t e) const {
  const Fan& fan = fans_[e];
  if (edges_[e].boundary) {
    const auto [from, to] = planesAt(fan);
    if (from == to) return 0;
    return isAlong(fan.vector, 3 - from - to, tolerance_) ? kSingular : kImpossible;
  }
  const lattice::Rotation total = holonomy(fan);
  if (total.isIdentity()) return 0;
  const int axis = total.axis();
  if (axis < 0 || !isAlong(fan.vector, axis, tolerance_)) return kImpossible;
  return isHalfTurn(total) ? kHalfTurn : kSingular;
}

/// Tries all choices of one or two faces together; keeps the best.
bool PatchCharts::improve(std::span<const std::uint32_t> faces) {
  std::vector<std::uint32_t> around;
  for (const std::uint32_t f : faces) {
    around.insert(around.end(), faces_[f].edges.begin(), faces_[f].edges.end());
  }
  sortUnique(around);
  const auto localCost = [&] {
    double sum = 0;
    for (const std::uint32_t e : around) sum += edgeCost(e);
    for (const std::uint32_t f : faces) sum += kPerChoice * static_cast<double>(faces_[f].chosen);
    return sum;
  };
  Face& first = faces_[faces.front()];
  Face& last = faces_[faces.back()];
  const std::array<std::size_t, 2> before = {first.chosen, last.chosen};
  const double start = localCost();
  double best = start;
  std::array<std::size_t, 2> bestChoice = before;
  for (std::size_t i = 0; i < first.choices(); ++i) {
    first.chosen = i;
    for (std::size_t j = 0; j < last.choices(); ++j) {
      if (faces.size() == 1 && j != i) continue;
      last.chosen = j;
      const double now = localCost();
      if (now >= best - kPerChoice / 2) continue;
      best = now;
      bestChoice = {i, j};
    }
  }
  first.chosen = bestChoice[0];
  last.chosen = bestChoice[1];
  return best < start;
}

/// Coordinate descent over single faces, then over pairs of faces with a common edge, until nothing
/// improves.
void PatchCharts::resolve() {
  bool improved = !ambiguous_.empty();
  while (improved) {
    improved = false;
    for (const std::uint32_t f : ambiguous_) improved = improve(std::array{f}) || improved;
    if (improved) continue;
    for (const std::uint32_t f : ambiguous_) improved = improvePairs(f) || improved;
  }
}

/// Tries a face together with each of its ambiguous neighbours across edges.
bool PatchCharts::improvePairs(std::uint32_t f) {
  bool improved = false;
  for (const std::uint32_t e : faces_[f].edges) {
    std::vector<std::uint32_t> partners;
    for (const FanStep& step : fans_[e].steps) partners.push_back(step.face);
    if (edges_[e].boundary) {
      partners.push_back(fans_[e].firstBoundary);
      partners.push_back(fans_[e].lastBoundary);
    }
    for (const std::uint32_t g : partners) {
      if (g > f && faces_[g].choices() > 1) improved = improve(std::array{f, g}) || improved;
    }
  }
  return improved;
}

/// The sum of dihedral angles in right angles, counting flipped tets as negative.
double PatchCharts::signedAngle(const PatchEdge& edge, const Fan& fan) const {
  double sum = 0;
  const auto add = [&](Index tet) {
    sum += angleInMap(parameters_(tet), topology_.localCorner(tet, edge.vertex0),
                      topology_.localCorner(tet, edge.vertex1));
  };
  Index tet = edge.tet;
  for (const FanStep& step : fan.steps) {
    add(tet);
    const adjacency::HalfFace halfFace = faces_[step.face].halfFace;
    tet = adjacency::tetOf(step.forward ? topology_.mate[halfFace] : halfFace);
  }
  if (edge.boundary) add(tet);
  return sum / (std::numbers::pi / 2);
}

/// Whether both ends of an edge are on one line of the integer grid, as on singular edges.
bool PatchCharts::isOnGridLine(Index tet, const PatchEdge& edge) const {
  const Vec3 a = parameters_(tet, topology_.localCorner(tet, edge.vertex0));
  const Vec3 b = parameters_(tet, topology_.localCorner(tet, edge.vertex1));
  const std::size_t along = dominantAxis(minus(b, a));
  for (std::size_t k = 0; k < 3; ++k) {
    if (k == along) continue;
    const double line = std::nearbyint(a[k]);
    if (std::abs(a[k] - line) > tolerance_ || std::abs(b[k] - line) > tolerance_) return false;
  }
  return true;
}

void PatchCharts::setValence(std::size_t e) {
  PatchEdge& edge = edges_[e];
  if (!map_.edgeValences.empty()) {
    edge.valence = edge.boundary ? 2 : 4;
    for (const EdgeValence& known : map_.edgeValences) {
      const auto [low, high] = std::minmax(known.vertex0, known.vertex1);
      if (low == edge.vertex0 && high == edge.vertex1) edge.valence += known.offset;
    }
    return;
  }
  const double angle = signedAngle(edge, fans_[e]);
  const int turns = static_cast<int>(std::lround(angle));
  const bool clear = std::abs(angle - turns) < 0.25;
  // Where tets are bad, the angle counts only if the holonomy confirms it and it is not a mere
  // fold.
  if (edge.sound) edge.valence = turns;
  if (!edge.sound && !edge.boundary && clear && turns >= 3 && turns != 4 &&
      isOnGridLine(edge.tet, edge)) {
    edge.valence = turns;
  }
}

void PatchCharts::classify() {
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    setValence(e);
    if (!(edges_[e].boundary ? classifyByPlanes(e) : classifyByHolonomy(e))) classifyByValence(e);
  }
}

/// A boundary edge between two planes is singular. Its valence is odd, if known.
bool PatchCharts::classifyByPlanes(std::size_t e) {
  PatchEdge& edge = edges_[e];
  const auto [from, to] = planesAt(fans_[e]);
  const bool even = edge.valence % 2 == 0;
  if (even != (from == to)) edge.valence = 0;
  if (from == to) return false;
  edge.singular = true;
  edge.axis = 3 - from - to;
  return true;
}

/// An interior edge around which charts turn is singular, too. Its valence fits the turn, if known.
bool PatchCharts::classifyByHolonomy(std::size_t e) {
  PatchEdge& edge = edges_[e];
  const lattice::Rotation total = holonomy(fans_[e]);
  const int rest = edge.valence % 4;
  const bool confirmed =
      total.isIdentity() ? rest == 0 : (isHalfTurn(total) ? rest == 2 : rest % 2 == 1);
  if (!confirmed) edge.valence = 0;
  if (total.isIdentity()) return false;
  const int axis = total.axis();
  edge.singular = true;
  edge.axis = axis >= 0 ? axis : static_cast<int>(dominantAxis(fans_[e].vector));
  return true;
}

/// All other edges are regular unless known otherwise, e.g. with twice the regular number of
/// hexahedra.
void PatchCharts::classifyByValence(std::size_t e) {
  PatchEdge& edge = edges_[e];
  const int regular = edge.boundary ? 2 : 4;
  if (edge.valence == 0) edge.valence = regular;
  edge.singular = edge.valence != regular;
  edge.axis = static_cast<int>(dominantAxis(fans_[e].vector));
}

const PatchEdge* PatchCharts::impossibleEdge() const {
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (edgeCost(e) >= kImpossible) return &edges_[e];
  }
  return nullptr;
}

}  // namespace hexhex::repairs
