#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

#include <quantize/seamless_conditions.hpp>
#include <quantize/seamless_map.hpp>

#include <base/vector3.hpp>
#include <igm/defects.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex {

namespace {

/// Coordinates on the lattice stay below this.
constexpr double kLargest = 0x1p52;

/// Shared unknowns are multiples of this: half of them are on the lattice, too, and two planes are
/// the same or so far apart that points between them can be rounded to the lattice.
constexpr std::int64_t kStep = 1 << 16;

/// Planes that are less apart than this share of the map's size are meant to be one.
constexpr double kNoise = 1e-9;
/// So many planes are compared with each other at most.
constexpr std::size_t kMostPlanes = 200'000;

std::vector<Rotation> fitRotations(const TetTopology& topology,
                                   std::span<const TetParameters> parameters) {
  std::vector<Rotation> rotations(topology.mate.size());
  for (HalfFace h = 0; h < rotations.size(); ++h) {
    const HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h) continue;
    const SharedFace face(topology, h, mate);
    const TetParameters& here = parameters[tetOf(h)];
    const TetParameters& there = parameters[tetOf(mate)];
    rotations[h] = bestRotation({minus(here[face.here(1)], here[face.here(0)]),
                                 minus(here[face.here(2)], here[face.here(0)])},
                                {minus(there[face.there(1)], there[face.there(0)]),
                                 minus(there[face.there(2)], there[face.there(0)])});
    rotations[mate] = rotations[h].inverse();
  }
  return rotations;
}

/// The axis to which a triangle is perpendicular.
std::uint8_t normalAxis(const CutGraph& graph, HalfFace h) {
  const TetParameters& u = graph.parameters[tetOf(h)];
  const auto corner = [&](std::size_t k) {
    return u[static_cast<std::size_t>(kFaceCorners[h % 4][k])];
  };
  return static_cast<std::uint8_t>(
      dominantAxis(cross(minus(corner(1), corner(0)), minus(corner(2), corner(0)))));
}

bool areLevel(const TetParameters& u, std::size_t a, std::size_t b, std::size_t axis,
              double tolerance) {
  return std::abs(u[a][axis] - u[b][axis]) <= tolerance;
}

/// The tets of a feature edge, or of a feature triangle (as half-faces).
std::optional<EdgeCorner> findEdge(const TetTopology& topology, Index v, Index w) {
  for (const CornerIndex corner : topology.star(v)) {
    const Tet& tet = topology.tets[corner / 4];
    for (std::uint8_t i = 0; i < 4; ++i) {
      if (tet[i] == w) return EdgeCorner{w, corner / 4, static_cast<std::uint8_t>(corner % 4), i};
    }
  }
  return std::nullopt;
}

HalfFace findFace(const TetTopology& topology, const std::array<Index, 3>& triangle) {
  for (const CornerIndex corner : topology.star(triangle[0])) {
    const Tet& tet = topology.tets[corner / 4];
    for (int face = 0; face < 4; ++face) {
      const auto isOn = [&](Index v) {
        const auto at = std::find(tet.begin(), tet.end(), v);
        return at != tet.end() && at - tet.begin() != face;
      };
      if (isOn(triangle[0]) && isOn(triangle[1]) && isOn(triangle[2])) {
        return halfFaceOf(corner / 4, face);
      }
    }
  }
  return kNone;
}

/// Triangles between regions, and tagged ones.
std::vector<HalfFace> innerFaces(const SeamlessMap& map, std::int32_t wallTag) {
  const TetTopology& topology = map.topology;
  const TetMapView& view = map.input.view;
  std::vector<HalfFace> faces;
  for (HalfFace h = 0; h < topology.mate.size() && !view.regions.empty(); ++h) {
    const HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h) continue;
    if (view.regions[tetOf(h)] != view.regions[tetOf(mate)]) faces.push_back(h);
  }
  for (const FeatureFace& feature : view.features.faces) {
    if (wallTag != 0 && feature.tag == wallTag) continue;
    const HalfFace h = findFace(topology, feature.vertices);
    if (h != kNone && topology.mate[h] != kNone) faces.push_back(h);
  }
  return faces;
}

/// The boundary, and those features that are aligned within the tolerance: the others are not in
/// the way of a seamless map, and will not be lines or planes of the mesh.
Alignment findAlignment(SeamlessMap& map, const CutGraph& graph, const SeamlessOptions& options) {
  const TetTopology& topology = map.topology;
  Alignment alignment;
  alignment.axes.assign(topology.mate.size(), kFree);
  for (HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (topology.mate[h] == kNone) alignment.axes[h] = normalAxis(graph, h);
  }
  for (const HalfFace h : innerFaces(map, options.wallTag)) {
    const std::uint8_t axis = normalAxis(graph, h);
    const auto& c = kFaceCorners[h % 4];
    const TetParameters& u = graph.parameters[tetOf(h)];
    const auto corner = [&](std::size_t k) { return static_cast<std::size_t>(c[k]); };
    if (!areLevel(u, corner(0), corner(1), axis, options.featureTolerance) ||
        !areLevel(u, corner(0), corner(2), axis, options.featureTolerance)) {
      continue;
    }
    alignment.axes[h] = axis;
    map.featureFaces.push_back(h);
  }
  for (const FeatureEdge& feature : map.input.view.features.edges) {
    const auto at = findEdge(topology, feature.vertices[0], feature.vertices[1]);
    if (!at) continue;
    const TetParameters& u = graph.parameters[at->tet];
    const auto along =
        static_cast<std::uint8_t>(dominantAxis(minus(u[at->corner1], u[at->corner0])));
    if (!areLevel(u, at->corner0, at->corner1, (along + 1U) % 3, options.featureTolerance) ||
        !areLevel(u, at->corner0, at->corner1, (along + 2U) % 3, options.featureTolerance)) {
      continue;
    }
    alignment.edges.push_back({*at, along});
    map.featureEdges.push_back(*at);
  }
  return alignment;
}

double largestCoordinate(const CutGraph& graph) {
  double largest = 0;
  for (const TetParameters& tet : graph.parameters) {
    for (const Vec3& u : tet) {
      for (const double x : u) largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

/// Exact parameters of a vertex in all its sectors.
class VertexSolver {
 public:
  VertexSolver(const TetTopology& topology, const CutGraph& graph,
               std::span<const std::int64_t> values, double unit)
      : topology_(topology),
        graph_(graph),
        values_(values),
        unit_(unit),
        bySector_(graph.sectorCount) {}

  /// @return false if a coordinate that is fixed is not on the lattice
  bool solve(Index vertex, const VertexConditions& conditions) {
    LatticePoint u = meanOf(vertex, conditions);
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexConditions::Fixed& fixed = conditions.fixed[k];
      if (fixed.factor == 0) continue;
      const std::int64_t rest = fixed.rest(values_);
      if (rest % fixed.factor != 0) return false;
      u[k] = -rest / fixed.factor;
    }
    for (const VertexConditions::Sector& sector : conditions.sectors) {
      bySector_[sector.sector] = sector.rotation(u) + translationOf(sector);
    }
    return true;
  }

  [[nodiscard]] const LatticePoint& operator[](Index sector) const { return bySector_[sector]; }

 private:
  [[nodiscard]] LatticePoint translationOf(const VertexConditions::Sector& sector) const {
    return {sector.translation[0](values_), sector.translation[1](values_),
            sector.translation[2](values_)};
  }

  /// Of the parameters given at all its corners, seen from the first sector.
  [[nodiscard]] LatticePoint meanOf(Index vertex, const VertexConditions& conditions) const {
    Vec3 sum{};
    for (const CornerIndex corner : topology_.star(vertex)) {
      const auto sector =
          std::find_if(conditions.sectors.begin(), conditions.sectors.end(),
                       [&](const auto& each) { return each.sector == graph_.sectors[corner]; });
      const LatticePoint t = translationOf(*sector);
      Vec3 u = graph_.parameters[corner / 4][corner % 4];
      for (std::size_t k = 0; k < 3; ++k) u[k] = u[k] * unit_ - static_cast<double>(t[k]);
      sum = plus(sum, sector->rotation.inverse()(u));
    }
    LatticePoint mean;
    const auto n = static_cast<double>(topology_.star(vertex).size());
    for (std::size_t k = 0; k < 3; ++k) mean[k] = std::llround(sum[k] / n);
    return mean;
  }

  const TetTopology& topology_;
  const CutGraph& graph_;
  std::span<const std::int64_t> values_;
  double unit_;
  std::vector<LatticePoint> bySector_;
};

[[noreturn]] void notSeamless(const std::string& what, Place place) {
  throw Error(
      ErrorCode::TransitionResidual,
      "The map is not seamless: " + what +
          " Quantization needs a map whose charts differ by "
          "rotations of the grid, and whose boundary and singular curves are aligned with axes.",
      place);
}

/// Exact corners from conditions and values of shared unknowns.
void solveVertices(SeamlessMap& map, const CutGraph& graph,
                   const std::vector<VertexConditions>& conditions,
                   std::span<const std::int64_t> values) {
  VertexSolver solver(map.topology, graph, values, map.unit);
  for (Index v = 0; v < map.topology.pointCount; ++v) {
    if (map.topology.isIsolated(v)) continue;
    if (!solver.solve(v, conditions[v])) {
      notSeamless("transitions around a vertex have no common fixed point.",
                  {PlaceKind::Vertex, v});
    }
  }
  map.corners.resize(map.topology.tetCount());
  for (CornerIndex corner = 0; corner < graph.sectors.size(); ++corner) {
    map.corners[corner / 4][corner % 4] = solver[graph.sectors[corner]];
  }
}

/// Between charts as they are after the cut.
void findChanges(SeamlessMap& map, const CutGraph& graph) {
  map.changes = FaceChanges(map.topology.mate.size());
  for (HalfFace h = 0; h < map.topology.mate.size(); ++h) {
    const HalfFace mate = map.topology.mate[h];
    if (mate == kNone) continue;
    const SharedFace face(map.topology, h, mate);
    const LatticeTet& here = map.corners[tetOf(h)];
    const LatticeTet& there = map.corners[tetOf(mate)];
    ChartChange change;
    if (graph.isCut[h]) change.rotation = graph.rotations[h];
    change.translation = there[face.there(0)] - change.rotation(here[face.here(0)]);
    map.changes.set(h, change);
    for (std::size_t k = 1; k < 3; ++k) {
      if (change(here[face.here(k)]) == there[face.there(k)]) continue;
      throw Error(ErrorCode::Internal, "A map that was made seamless is not. This is a bug.",
                  {PlaceKind::Face, tetOf(h), h % 4});
    }
  }
}

void measureDisplacement(SeamlessMap& map, const CutGraph& graph) {
  map.maxDisplacement = 0;
  for (Index t = 0; t < map.corners.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double moved = std::abs(static_cast<double>(map.corners[t][i][k]) / map.unit -
                                      graph.parameters[t][i][k]);
        if (moved <= map.maxDisplacement) continue;
        map.maxDisplacement = moved;
        map.mostDisplaced = t;
      }
    }
  }
}

void requireDisplacement(const SeamlessMap& map, double tolerance) {
  if (map.maxDisplacement <= tolerance) return;
  std::ostringstream what;
  what << "the nearest seamless map is " << map.maxDisplacement
       << " off, more than the tolerance of " << tolerance << '.';
  notSeamless(what.str(), {PlaceKind::Tet, map.mostDisplaced});
}

/// The seamless map that is nearest under all equations.
/// @return the values of shared unknowns
std::vector<std::int64_t> solve(SeamlessMap& map, const CutGraph& graph,
                                const SharedUnknowns& unknowns,
                                const std::vector<VertexConditions>& conditions,
                                const std::vector<IntegerForm>& equations) {
  const IntegerSystem system(unknowns.size(), equations);
  std::vector<double> wanted = system.nearest(unknowns.measured());
  for (double& x : wanted) x *= map.unit;
  // Nearly all that depends on others is their sum, or half of it; some is a third ...
  std::vector<std::int64_t> values;
  for (const std::int64_t divisible : {1, 3, 15, 105}) {
    if (values.empty()) values = system.roundedTo(wanted, divisible * kStep);
  }
  if (values.size() != unknowns.size()) {
    notSeamless("conditions of singular curves have no solution on the lattice.", {});
  }
  solveVertices(map, graph, conditions, values);
  measureDisplacement(map, graph);
  return values;
}

/// A coordinate that conditions fix, times two.
struct FixedCoordinate {
  std::size_t axis = 0;
  IntegerForm form;

  [[nodiscard]] auto operator<=>(const FixedCoordinate&) const = default;
};

/// All of a vertex, in the charts of its sectors.
void collectFixed(const VertexConditions& conditions, std::set<FixedCoordinate>& all) {
  for (const VertexConditions::Sector& sector : conditions.sectors) {
    for (int from = 0; from < 3; ++from) {
      const auto& [factor, rest] = conditions.fixed[static_cast<std::size_t>(from)];
      if (factor == 0 || 2 % factor != 0) continue;
      const Direction to = sector.rotation(direction(from, 1));
      FixedCoordinate fixed;
      fixed.axis = static_cast<std::size_t>(axisOf(to));
      fixed.form.add(rest, -signOf(to) * 2 / factor);
      fixed.form.add(sector.translation[fixed.axis], 2);
      all.insert(std::move(fixed));
    }
  }
}

/// The same planes as they are beyond pieces of the cut.
std::set<FixedCoordinate> beyondCut(const std::set<FixedCoordinate>& here, const CutGraph& graph,
                                    const SharedUnknowns& unknowns) {
  std::set<FixedCoordinate> all = here;
  for (const HalfFace h : unknowns.cutPieces()) {
    for (const FixedCoordinate& fixed : here) {
      const Direction to = graph.rotations[h](direction(static_cast<int>(fixed.axis), 1));
      FixedCoordinate there;
      there.axis = static_cast<std::size_t>(axisOf(to));
      there.form.add(fixed.form, signOf(to));
      there.form.add(unknowns.translation(h, there.axis), 2);
      all.insert(std::move(there));
    }
  }
  return all;
}

/// Equations for what is fixed at nearly the same coordinate of the common charts: as symmetric
/// objects have it.
/// @return whether there are any
bool addCoincidences(const CutGraph& graph, const SharedUnknowns& unknowns,
                     const std::vector<VertexConditions>& conditions,
                     std::span<const std::int64_t> values, double noise,
                     std::vector<IntegerForm>& equations) {
  std::set<FixedCoordinate> all;
  for (const VertexConditions& vertex : conditions) collectFixed(vertex, all);
  // Walls cross the cut, some of them twice.
  for (int crossing = 0; crossing < 2; ++crossing) {
    if (all.size() * unknowns.cutPieces().size() > kMostPlanes) break;
    all = beyondCut(all, graph, unknowns);
  }
  std::vector<std::tuple<std::size_t, std::int64_t, const IntegerForm*>> sorted;
  sorted.reserve(all.size());
  for (const FixedCoordinate& each : all) {
    sorted.emplace_back(each.axis, each.form(values), &each.form);
  }
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
  });
  const std::size_t count = equations.size();
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const auto& [axis, value, form] = sorted[i];
    const auto& [otherAxis, otherValue, otherForm] = sorted[i - 1];
    const auto apart = static_cast<double>(value - otherValue);
    if (axis != otherAxis || apart == 0 || apart > 2 * noise) continue;
    equations.push_back(*form);
    equations.back().add(*otherForm, -1);
  }
  return equations.size() > count;
}

}  // namespace

double volumeOf(const SeamlessMap& map) {
  double volume = 0;
  for (const LatticeTet& u : map.corners) {
    volume += orientationDeterminant(u[0], u[1], u[2], u[3]).toDouble() / 6;
  }
  return volume / (map.unit * map.unit * map.unit);
}

void requirePositiveTets(const SeamlessMap& map) {
  DefectCollector defects;
  defects.setCornersReversed(map.input.cornersReversed);
  for (Index t = 0; t < map.corners.size(); ++t) {
    const LatticeTet& u = map.corners[t];
    if (orientation(u[0], u[1], u[2], u[3]) <= 0) {
      defects.add(ErrorCode::FlippedTet, {PlaceKind::Tet, t}, 0);
    }
  }
  defects.throwIfAny();
}

SeamlessMap makeSeamless(const TetMapView& map, const SeamlessOptions& options, Context& context) {
  Stage stage(context, "seamless map");
  DefectCollector defects;
  SeamlessMap result;
  result.input = readInput(map, stage, defects);
  defects.throwIfAny();
  result.topology = buildTopology(result.input.view, stage, defects);
  defects.throwIfAny();
  addStars(result.topology, stage);
  const TetTopology& topology = result.topology;
  const EdgeFans edges(topology);
  const std::span<const TetParameters> parameters = result.input.view.parameters;
  const CutGraph graph = cutOpen(topology, edges, parameters, fitRotations(topology, parameters));
  const SharedUnknowns unknowns(topology, edges, graph, findAlignment(result, graph, options));
  std::vector<IntegerForm> equations = unknowns.equations();
  std::vector<VertexConditions> conditions(topology.pointCount);
  for (Index v = 0; v < topology.pointCount; ++v) {
    if (topology.isIsolated(v)) continue;
    conditions[v] = conditionsOf(v, topology, graph, unknowns, equations);
    if (!conditions[v].isAxisParallel) {
      notSeamless("a singular curve is not parallel to an axis.", {PlaceKind::Vertex, v});
    }
  }
  result.unit =
      std::exp2(std::floor(std::log2(kLargest / std::max(largestCoordinate(graph), 1e-300))));
  const std::vector<std::int64_t> values = solve(result, graph, unknowns, conditions, equations);
  // Once more with all planes as one that noise alone keeps apart: walls between them were a mess.
  const double noise = std::max(kNoise * largestCoordinate(graph), result.maxDisplacement);
  if (addCoincidences(graph, unknowns, conditions, values, noise * result.unit, equations)) {
    static_cast<void>(solve(result, graph, unknowns, conditions, equations));
  }
  findChanges(result, graph);
  requireDisplacement(result, options.tolerance);
  result.input.view.parameters = {};
  result.input.parameters = {};
  return result;
}

}  // namespace hexhex
