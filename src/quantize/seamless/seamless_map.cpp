#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include <quantize/seamless/coincidences.hpp>
#include <quantize/seamless/seamless_conditions.hpp>
#include <quantize/seamless/seamless_map.hpp>

#include <base/vector3.hpp>
#include <igm/defects.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex::quantization {

namespace {

/// Bound of coordinates in lattice units.
constexpr double kLargest = 0x1p52;

/// Bound of a map's size and its inverse, so that products of eight lengths stay finite.
constexpr double kMostSize = 0x1p100;

/// Shared unknowns are multiples of this, so that halves of them are on the lattice as well, and
/// two planes either coincide or leave enough lattice points between them for rounding.
constexpr std::int64_t kStep = 1 << 16;

/// Planes closer than this fraction of the map's size are considered one.
constexpr double kNoise = 1e-9;
/// Maximum displacement by joining them, as a multiple of the noise.
constexpr double kChainedNoise = 16;
/// Joining planes may bring others close to each other; nearly all are found in the first round.
constexpr int kRoundsOfPreferences = 3;

/// The axis perpendicular to a triangle, as the one along which it extends least: the normal of a
/// thin triangle may be noise.
std::uint8_t normalAxis(const CutGraph& graph, adjacency::HalfFace h) {
  const TetParameters& u = graph.parameters[adjacency::tetOf(h)];
  const auto corner = [&](std::size_t k) {
    return u[static_cast<std::size_t>(lattice::kFaceCorners[h % 4][k])];
  };
  std::array<double, 3> extents{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::minmax({corner(0)[axis], corner(1)[axis], corner(2)[axis]});
    extents[axis] = most - least;
  }
  return static_cast<std::uint8_t>(std::min_element(extents.begin(), extents.end()) -
                                   extents.begin());
}

bool areLevel(const TetParameters& u, std::size_t a, std::size_t b, std::size_t axis,
              double tolerance) {
  return std::abs(u[a][axis] - u[b][axis]) <= tolerance;
}

std::optional<adjacency::TetEdge> findEdge(const adjacency::TetTopology& topology, Index v,
                                           Index w) {
  for (const adjacency::CornerIndex corner : topology.star(v)) {
    const Tet& tet = topology.tets[corner / 4];
    for (std::uint8_t i = 0; i < 4; ++i) {
      if (tet[i] == w)
        return adjacency::TetEdge{corner / 4, static_cast<std::uint8_t>(corner % 4), i};
    }
  }
  return std::nullopt;
}

adjacency::HalfFace findFace(const adjacency::TetTopology& topology,
                             const std::array<Index, 3>& triangle) {
  for (const adjacency::CornerIndex corner : topology.star(triangle[0])) {
    const Tet& tet = topology.tets[corner / 4];
    for (int face = 0; face < 4; ++face) {
      const auto isOn = [&](Index v) {
        const auto at = std::find(tet.begin(), tet.end(), v);
        return at != tet.end() && at - tet.begin() != face;
      };
      if (isOn(triangle[0]) && isOn(triangle[1]) && isOn(triangle[2])) {
        return adjacency::halfFaceOf(corner / 4, face);
      }
    }
  }
  return kNone;
}

/// Triangles between regions, and tagged ones except those with `wallTag`.
std::vector<adjacency::HalfFace> innerFaces(const SeamlessMap& map, std::int32_t wallTag) {
  const adjacency::TetTopology& topology = map.topology;
  const TetMapView& view = map.input.view;
  std::vector<adjacency::HalfFace> faces;
  for (adjacency::HalfFace h = 0; h < topology.mate.size() && !view.regions.empty(); ++h) {
    const adjacency::HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h) continue;
    if (view.regions[adjacency::tetOf(h)] != view.regions[adjacency::tetOf(mate)])
      faces.push_back(h);
  }
  for (const FeatureFace& feature : view.features.faces) {
    if (wallTag != 0 && feature.tag == wallTag) continue;
    const adjacency::HalfFace h = findFace(topology, feature.vertices);
    if (h != kNone && topology.mate[h] != kNone) faces.push_back(h);
  }
  return faces;
}

/// Aligns the boundary, singular edges that charts do not reveal, and features that are
/// axis-aligned within the tolerance. Other features do not prevent a seamless map, but hexahedra
/// will not follow them.
Alignment findAlignment(SeamlessMap& map, const adjacency::EdgeFans& edges, const CutGraph& graph,
                        const SeamlessOptions& options) {
  const adjacency::TetTopology& topology = map.topology;
  const double tolerance = options.featureTolerance * map.size;
  Alignment alignment;
  alignment.axes.assign(topology.mate.size(), kFree);
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (topology.mate[h] == kNone) alignment.axes[h] = normalAxis(graph, h);
  }
  for (const adjacency::HalfFace h : innerFaces(map, options.wallTag)) {
    const std::uint8_t axis = normalAxis(graph, h);
    const auto& c = lattice::kFaceCorners[h % 4];
    const TetParameters& u = graph.parameters[adjacency::tetOf(h)];
    const auto corner = [&](std::size_t k) { return static_cast<std::size_t>(c[k]); };
    if (!areLevel(u, corner(0), corner(1), axis, tolerance) ||
        !areLevel(u, corner(0), corner(2), axis, tolerance)) {
      continue;
    }
    alignment.axes[h] = axis;
    map.featureFaces.push_back(h);
  }
  const auto addEdge = [&](const adjacency::TetEdge& at, std::uint8_t along) {
    alignment.edges.push_back({at, along});
    map.featureEdges.push_back(at);
  };
  const auto axisAlong = [&graph](const adjacency::TetEdge& at) {
    const TetParameters& u = graph.parameters[at.tet];
    return static_cast<std::uint8_t>(dominantAxis(minus(u[at.corner1], u[at.corner0])));
  };
  const std::vector<int> quarters = quartersAround(edges, std::span(graph.parameters));
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    if (!isSingularByTurnsAlone(edges, edge, quarters[edge])) continue;
    addEdge(edges(edge).front(), axisAlong(edges(edge).front()));
  }
  for (const FeatureEdge& feature : map.input.view.features.edges) {
    const auto at = findEdge(topology, feature.vertices[0], feature.vertices[1]);
    if (!at) continue;
    const TetParameters& u = graph.parameters[at->tet];
    const std::uint8_t along = axisAlong(*at);
    if (!areLevel(u, at->corner0, at->corner1, (along + 1U) % 3, tolerance) ||
        !areLevel(u, at->corner0, at->corner1, (along + 2U) % 3, tolerance)) {
      continue;
    }
    addEdge(*at, along);
  }
  return alignment;
}

/// The largest absolute coordinate; the first tet of each component starts at the origin.
double largestCoordinate(const CutGraph& graph) {
  double largest = 0;
  for (const TetParameters& tet : graph.parameters) {
    for (const Vec3& u : tet) {
      for (const double x : u) largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

/// Computes exact parameters of a vertex in all its sectors.
class VertexSolver {
 public:
  VertexSolver(const adjacency::TetTopology& topology, const CutGraph& graph,
               std::span<const std::int64_t> values, double unit)
      : topology_(topology),
        graph_(graph),
        values_(values),
        unit_(unit),
        bySector_(graph.sectorCount) {}

  /// @return false if a fixed coordinate is not on the lattice
  bool solve(Index vertex, const VertexConditions& conditions) {
    lattice::LatticePoint u = meanOf(vertex, conditions);
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

  [[nodiscard]] const lattice::LatticePoint& operator[](Index sector) const {
    return bySector_[sector];
  }

 private:
  [[nodiscard]] lattice::LatticePoint translationOf(const VertexConditions::Sector& sector) const {
    return {sector.translation[0](values_), sector.translation[1](values_),
            sector.translation[2](values_)};
  }

  /// The mean of the given parameters of all its corners, carried to the first sector.
  [[nodiscard]] lattice::LatticePoint meanOf(Index vertex,
                                             const VertexConditions& conditions) const {
    Vec3 sum{};
    for (const adjacency::CornerIndex corner : topology_.star(vertex)) {
      const auto sector =
          std::find_if(conditions.sectors.begin(), conditions.sectors.end(),
                       [&](const auto& each) { return each.sector == graph_.sectors[corner]; });
      const lattice::LatticePoint t = translationOf(*sector);
      Vec3 u = graph_.parameters[corner / 4][corner % 4];
      for (std::size_t k = 0; k < 3; ++k) u[k] = u[k] * unit_ - static_cast<double>(t[k]);
      sum = plus(sum, sector->rotation.inverse()(u));
    }
    lattice::LatticePoint mean;
    const auto n = static_cast<double>(topology_.star(vertex).size());
    for (std::size_t k = 0; k < 3; ++k) mean[k] = std::llround(sum[k] / n);
    return mean;
  }

  const adjacency::TetTopology& topology_;
  const CutGraph& graph_;
  std::span<const std::int64_t> values_;
  double unit_;
  std::vector<lattice::LatticePoint> bySector_;
};

std::vector<Index> flippedTets(std::span<const lattice::LatticeTet> corners) {
  std::vector<Index> flipped;
  for (Index t = 0; t < corners.size(); ++t) {
    const lattice::LatticeTet& u = corners[t];
    if (lattice::orientation(u[0], u[1], u[2], u[3]) <= 0) flipped.push_back(t);
  }
  return flipped;
}

/// Tets that are flipped in the given map. Evaluated on the lattice, which resolves the last digit
/// of the largest coordinates.
std::vector<Index> flippedAsGiven(const CutGraph& graph, double unit) {
  std::vector<lattice::LatticeTet> corners(graph.parameters.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners[t][i][k] = std::llround(graph.parameters[t][i][k] * unit);
      }
    }
  }
  return flippedTets(corners);
}

void throwFlipped(std::span<const Index> flipped) {
  igm::DefectCollector defects;
  for (const Index t : flipped) defects.add(ErrorCode::FlippedTet, {PlaceKind::Tet, t}, 0);
  defects.throwIfAny();
}

/// Reports flipped tets first, since they may cause other faults.
[[noreturn]] void notSeamless(const SeamlessMap& map, const std::string& what, Place place) {
  throwFlipped(map.flippedAsGiven);
  throw Error(
      ErrorCode::TransitionResidual,
      "The map is not seamless: " + what +
          " Quantization needs a map whose charts differ by "
          "rotations of the grid, and whose boundary and singular curves are aligned with axes.",
      place);
}

void requireSize(double size) {
  if (size >= 1 / kMostSize && size <= kMostSize) return;
  std::ostringstream what;
  what << "The map's parameters extend over " << size
       << ". Quantization takes maps of 1e-30 to 1e30: multiply them by a constant.";
  throw Error(ErrorCode::TooLarge, what.str());
}

/// No corner may move by more than the tolerance, so the translations at a triangle's corners
/// differ by at most four times that. Checked early, since a map far from seamless has countless
/// conditions.
void requireTransitions(const SeamlessMap& map, const CutGraph& graph, double tolerance) {
  const adjacency::TetTopology& topology = map.topology;
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    const adjacency::HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h) continue;
    const igm::SharedTriangle triangle(topology, graph.parameters, h);
    const lattice::Rotation rotation = graph.isCut[h] ? graph.rotations[h] : lattice::Rotation{};
    std::array<Vec3, 3> translations;
    for (std::size_t k = 0; k < 3; ++k) {
      translations[k] = minus(triangle.there[k], rotation(triangle.here[k]));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [least, most] =
          std::minmax({translations[0][axis], translations[1][axis], translations[2][axis]});
      if (most - least <= 4 * tolerance) continue;
      std::ostringstream what;
      what << "a triangle differs by " << most - least
           << " between its two tets, more than four times the tolerance of " << tolerance << '.';
      const auto corner =
          static_cast<std::uint64_t>(map.input.callersCorner(adjacency::localOf(h)));
      notSeamless(map, what.str(), {PlaceKind::Face, adjacency::tetOf(h), corner});
    }
  }
}

/// Whether the charts around an interior edge agree, or turn about an axis parallel to the edge.
bool turnsAboutItsAxis(const adjacency::TetTopology& topology, const CutGraph& graph,
                       const adjacency::TetEdge& at, double tolerance) {
  const std::optional<lattice::Rotation> around = adjacency::visitAroundEdge(
      topology, at.tet, at.mask(), lattice::Rotation{},
      [&](lattice::Rotation rotation, adjacency::HalfFace out) {
        return graph.rotations[out] * rotation;
      },
      [](const auto& /*turn*/, lattice::Rotation /*rotation*/) { return true; });
  if (!around || around->isIdentity()) return true;
  if (around->axis() < 0) return false;
  const auto axis = static_cast<std::size_t>(around->axis());
  // Each end moves by at most the tolerance.
  const TetParameters& u = graph.parameters[at.tet];
  return areLevel(u, at.corner0, at.corner1, (axis + 1) % 3, 2 * tolerance) &&
         areLevel(u, at.corner0, at.corner1, (axis + 2) % 3, 2 * tolerance);
}

/// Requires singular edges to be parallel to an axis, as hexahedra fit around no others. This also
/// ensures that charts impose conditions on single coordinates of a vertex only.
void requireAxesOfCurves(const SeamlessMap& map, const adjacency::EdgeFans& edges,
                         const CutGraph& graph, double tolerance) {
  const adjacency::TetTopology& topology = map.topology;
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    const adjacency::EdgeCorner& at = edges(edge).front();
    if (edges.isBoundary(edge) || turnsAboutItsAxis(topology, graph, at, tolerance)) continue;
    const Tet& tet = topology.tets[at.tet];
    notSeamless(map, "a singular curve is parallel to no axis.",
                {PlaceKind::Edge, tet[at.corner0], tet[at.corner1]});
  }
}

/// Computes exact corners, given values of shared unknowns.
void solveVertices(SeamlessMap& map, const CutGraph& graph,
                   const std::vector<VertexConditions>& conditions,
                   std::span<const std::int64_t> values) {
  VertexSolver solver(map.topology, graph, values, map.unit);
  for (Index v = 0; v < map.topology.pointCount; ++v) {
    if (map.topology.isIsolated(v)) continue;
    if (!solver.solve(v, conditions[v])) {
      notSeamless(map, "transitions around a vertex have no common fixed point.",
                  {PlaceKind::Vertex, v});
    }
  }
  map.corners.resize(map.topology.tetCount());
  for (adjacency::CornerIndex corner = 0; corner < graph.sectors.size(); ++corner) {
    map.corners[corner / 4][corner % 4] = solver[graph.sectors[corner]];
  }
}

/// Computes the transitions between the charts, and checks that the map is seamless.
void findChanges(SeamlessMap& map, const CutGraph& graph) {
  map.changes = FaceMotions(map.topology.mate.size());
  for (adjacency::HalfFace h = 0; h < map.topology.mate.size(); ++h) {
    if (map.topology.mate[h] == kNone) continue;
    const adjacency::SharedCorners<lattice::LatticePoint> face(
        map.topology, h, [&](Index tet, std::size_t corner) { return map.corners[tet][corner]; });
    const auto change = lattice::LatticeMotion::taking(
        face.here[0], face.there[0], graph.isCut[h] ? graph.rotations[h] : lattice::Rotation{});
    map.changes.set(h, change);
    for (std::size_t k = 1; k < 3; ++k) {
      if (change(face.here[k]) == face.there[k]) continue;
      throw Error(ErrorCode::Internal, "A map that was made seamless is not. This is a bug.",
                  {PlaceKind::Face, adjacency::tetOf(h), h % 4});
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
  notSeamless(map, what.str(), {PlaceKind::Tet, map.mostDisplaced});
}

/// The corners of the nearest seamless map, computed from conditions on shared unknowns.
class NearestMap {
 public:
  NearestMap(SeamlessMap& map, const CutGraph& graph, const SharedUnknowns& unknowns)
      : map_(map), graph_(graph), unknowns_(unknowns), equations_(unknowns.equations()) {
    const adjacency::TetTopology& topology = map.topology;
    conditions_.resize(topology.pointCount);
    for (Index v = 0; v < topology.pointCount; ++v) {
      if (topology.isIsolated(v)) continue;
      conditions_[v] = conditionsOf(v, topology, graph, unknowns, equations_);
    }
  }

  void find() {
    values_ = nearest({});
    if (values_.empty() && unknowns_.size() > 0) {
      notSeamless(map_, "conditions of singular curves have no solution on the lattice.", {});
    }
    take(values_);
  }

  /// Solves again with planes joined that only noise separates: walls between them would be
  /// chaotic.
  /// @pre find() was called
  void joinPlanes(double noise) {
    std::vector<IntegerForm> preferences;
    std::vector<std::int64_t> best = values_;
    for (int round = 0; round < kRoundsOfPreferences; ++round) {
      const auto more = coincidences(graph_, unknowns_, conditions_, best, noise * map_.unit,
                                     map_.size * map_.unit);
      if (more.empty()) break;
      preferences.insert(preferences.end(), more.begin(), more.end());
      best = nearest(preferences);
      if (best.empty()) break;
      take(best);
    }
    // Chains of near coincidences may lead far away; joined planes are given up then.
    if (map_.maxDisplacement > kChainedNoise * noise) take(values_);
  }

 private:
  /// Values of the shared unknowns for the nearest seamless map.
  /// @param preferences  further equations, honoured unless they produce fractions
  /// @return empty if the values are not on the lattice
  [[nodiscard]] std::vector<std::int64_t> nearest(
      const std::vector<IntegerForm>& preferences) const {
    const IntegerSystem system(unknowns_.size(), equations_, preferences);
    std::vector<double> wanted = system.nearest(unknowns_.measured());
    for (double& x : wanted) x *= map_.unit;
    // Nearly all dependent values are sums of others, or half of that, and the step is a power of
    // two; a few are thirds, ninths ...
    std::vector<std::int64_t> values;
    for (const std::int64_t divisible : {1, 3, 15, 105, 315, 945}) {
      if (values.empty()) values = system.roundedTo(wanted, divisible * kStep);
    }
    if (values.size() != unknowns_.size()) values.clear();
    return values;
  }

  void take(std::span<const std::int64_t> values) {
    solveVertices(map_, graph_, conditions_, values);
    measureDisplacement(map_, graph_);
  }

  SeamlessMap& map_;
  const CutGraph& graph_;
  const SharedUnknowns& unknowns_;
  std::vector<IntegerForm> equations_;
  std::vector<VertexConditions> conditions_;
  std::vector<std::int64_t> values_;
};

}  // namespace

double volumeOf(const SeamlessMap& map) {
  double volume = 0;
  for (const lattice::LatticeTet& u : map.corners) {
    volume += lattice::orientationDeterminant(u[0], u[1], u[2], u[3]).toDouble() / 6;
  }
  return volume / (map.unit * map.unit * map.unit);
}

void requirePositiveTets(const SeamlessMap& map) {
  const std::vector<Index> flipped = flippedTets(map.corners);
  if (flipped.empty()) return;
  throwFlipped(map.flippedAsGiven);
  throwFlipped(flipped);
}

SeamlessMap makeSeamless(const TetMapView& map, const SeamlessOptions& options, Context& context) {
  Stage stage(context, "seamless map");
  igm::DefectCollector defects;
  SeamlessMap result;
  result.input = igm::readInput(map, stage, defects);
  defects.throwIfAny();
  result.topology = igm::buildTopology(result.input.view, stage, defects);
  defects.throwIfAny();
  // Walks around edges and vertices terminate only on manifolds.
  igm::collectTopologyDefects(result.topology, stage, defects);
  defects.throwIfAny();
  const adjacency::TetTopology& topology = result.topology;
  const adjacency::EdgeFans edges(topology);
  const std::span<const TetParameters> parameters = result.input.view.parameters;
  const CutGraph graph = cutOpen(topology, edges, parameters, fitRotations(topology, parameters));
  result.size = largestCoordinate(graph);
  requireSize(result.size);
  result.unit = std::exp2(std::floor(std::log2(kLargest / result.size)));
  requireTransitions(result, graph, options.tolerance * result.size);
  result.flippedAsGiven = flippedAsGiven(graph, result.unit);
  requireAxesOfCurves(result, edges, graph, options.tolerance * result.size);
  const SharedUnknowns unknowns(topology, edges, graph,
                                findAlignment(result, edges, graph, options));
  NearestMap nearest(result, graph, unknowns);
  nearest.find();
  if (flippedTets(result.corners).empty()) result.flippedAsGiven.clear();
  requireDisplacement(result, options.tolerance * result.size);
  const double noise =
      std::max(std::max(kNoise, options.apart) * result.size, result.maxDisplacement);
  nearest.joinPlanes(noise);
  findChanges(result, graph);
  requireDisplacement(result, std::max(options.tolerance * result.size, kChainedNoise * noise));
  result.input.view.parameters = {};
  result.input.parameters = {};
  return result;
}

}  // namespace hexhex::quantization
