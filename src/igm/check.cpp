// Checks a map by the first steps of Section 5.1, without extracting its mesh: its measures,
// defects, singular edges and transitions.
#include <array>
#include <cmath>

#include <hexhex/check.hpp>
#include <hexhex/map_structure.hpp>

#include <igm/measures.hpp>

namespace hexhex::igm {

namespace {

void countElements(const adjacency::TetTopology& topology, CheckReport& report) {
  for (const adjacency::HalfFace mate : topology.mate)
    report.boundaryFaces += mate == kNone ? 1 : 0;
  report.innerFaces = (4 * topology.tetCount() - report.boundaryFaces) / 2;
  report.faces = report.innerFaces + report.boundaryFaces;
  for (Index v = 0; v < topology.pointCount; ++v) {
    report.isolatedVertices += topology.isIsolated(v) ? 1 : 0;
  }
}

void countSingularities(const Singularities& singularities, CheckReport& report) {
  for (const SingularEdge& edge : singularities.edges) {
    ++(edge.boundary ? report.boundarySingularTetEdges
                     : report.innerSingularTetEdges)[edge.valence];
  }
  for (Index v = 0; v + 1 < singularities.begin.size(); ++v) {
    report.singularNodes += singularities.isNode(v) ? 1 : 0;
  }
}

using RotationMatrix = std::array<std::array<std::int8_t, 3>, 3>;

/// A rotation between the pipeline's charts, as one between the caller's: if the map is mirrored,
/// the first parameter is negated in all of the pipeline's charts.
RotationMatrix matrixOf(const lattice::Rotation& rotation, bool mirrored) {
  RotationMatrix matrix{};
  for (std::size_t column = 0; column < 3; ++column) {
    std::array<std::int8_t, 3> unit{};
    unit[column] = 1;
    const std::array<std::int8_t, 3> image = rotation(unit);
    for (std::size_t row = 0; row < 3; ++row) {
      const bool negated = mirrored && (row == 0) != (column == 0);
      matrix[row][column] = static_cast<std::int8_t>(negated ? -image[row] : image[row]);
    }
  }
  return matrix;
}

/// The integers nearest to what the rotation leaves of the face's corner parameters. (The pipeline
/// has moved charts towards the origin; these are the caller's.)
std::array<double, 3> translationOf(const TetMapView& map, const ChartJump& jump) {
  std::array<double, 3> first{};  // separate, as sums of large numbers would be rounded
  std::array<double, 3> sum{};
  for (const Index vertex : jump.vertices) {
    std::array<Vec3, 2> u{};
    for (std::size_t side = 0; side < 2; ++side) {
      const Tet& tet = map.tets[jump.tets[side]];
      std::size_t corner = 0;
      while (tet[corner] != vertex) ++corner;
      u[side] = map.parameters[jump.tets[side]][corner];
    }
    for (std::size_t row = 0; row < 3; ++row) {
      const auto& r = jump.rotation[row];
      const double rest = u[1][row] - (r[0] * u[0][0] + r[1] * u[0][1] + r[2] * u[0][2]);
      if (vertex == jump.vertices[0]) first[row] = std::nearbyint(rest) + 0.0;  // no -0
      sum[row] += rest - first[row];
    }
  }
  for (std::size_t row = 0; row < 3; ++row) first[row] += std::nearbyint(sum[row] / 3);
  return first;
}

bool isIdentity(const ChartJump& jump) {
  constexpr RotationMatrix kIdentity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return jump.rotation == kIdentity && jump.translation == std::array<double, 3>{};
}

void addChartJumps(const TetMapView& map, const PreparedMap& prepared, MapStructure& result) {
  const adjacency::TetTopology& topology = prepared.topology;
  const Transitions& transitions = prepared.exact.transitions;
  for (adjacency::HalfFace face = 0; face < topology.mate.size(); ++face) {
    const adjacency::HalfFace mate = topology.mate[face];
    if (mate == kNone || adjacency::tetOf(mate) < adjacency::tetOf(face)) continue;
    ChartJump jump;
    jump.tets = {adjacency::tetOf(face), adjacency::tetOf(mate)};
    std::size_t next = 0;
    for (const Index vertex : map.tets[adjacency::tetOf(face)]) {
      if (vertex != topology.vertex(face)) jump.vertices[next++] = vertex;
    }
    jump.rotation = matrixOf(transitions.across(face).rotation, prepared.input.mirrored);
    jump.translation = translationOf(map, jump);
    if (!isIdentity(jump)) result.chartJumps.push_back(jump);
  }
}

}  // namespace

}  // namespace hexhex::igm

namespace hexhex {

CheckReport check(const TetMapView& map, const CheckOptions& options, Context& context) {
  constexpr std::array<WorkStep, 2> kSteps = {{{"prepare", 3}, {"measures", 1}}};
  WorkSteps steps(context, "check", kSteps);
  CheckReport report;
  report.points = map.points.size();
  report.tets = map.tets.size();
  withThreads(context.threads(), [&] {
    igm::DefectCollector defects;
    igm::PreparedMap prepared =
        igm::prepareMap(map, options.tolerance, options.scale, context, defects);
    Stage stage(context, "measures");
    if (defects.empty()) {
      const double cells =
          static_cast<double>(igm::parametricVolume(prepared.exact)) * std::pow(options.scale, 3);
      if (cells >= igm::kMaxCountedCells) defects.add(ErrorCode::TooLarge, {}, cells);
    }
    report.defects = defects.defects();
    report.mirrored = prepared.input.mirrored;
    report.cornersReversed = prepared.input.cornersReversed;
    report.tetsInvertedInSpace = prepared.input.tetsInvertedInSpace;
    // What could not be computed because of a defect stays empty, and counts as nothing.
    if (!prepared.singularities.areKnown()) return;
    adjacency::addStars(prepared.topology, stage);
    report.edges = adjacency::countEdges(prepared.topology, stage);
    igm::countElements(prepared.topology, report);
    report.chartJumps = prepared.exact.transitions.nonTrivial;
    report.maxTransitionResidual = prepared.exact.transitions.maxResidual;
    report.maxDisplacement = prepared.exact.maxDisplacement;
    igm::countSingularities(prepared.singularities, report);
    report.boundaryGenus = igm::boundaryGenus(prepared.topology);
    if (report.valid())
      report.expected = igm::computeExpectation(prepared, report.edges, options.scale);
  });
  steps.finish();
  return report;
}

CheckReport check(const TetMapView& map, const CheckOptions& options) {
  Context context;
  return check(map, options, context);
}

MapStructure findMapStructure(const TetMapView& map, double tolerance, Context& context) {
  constexpr std::array<WorkStep, 2> kSteps = {{{"prepare", 3}, {"map structure", 1}}};
  WorkSteps steps(context, "findMapStructure", kSteps);
  MapStructure result;
  withThreads(context.threads(), [&] {
    igm::DefectCollector defects;
    const igm::PreparedMap prepared = igm::prepareMap(map, tolerance, 1, context, defects);
    result.defects = defects.defects();
    const Stage stage(context, "map structure");
    for (const igm::SingularEdge& edge : prepared.singularities.edges) {
      result.singularEdges.push_back({edge.vertex0, edge.vertex1, edge.valence, edge.boundary});
    }
    if (!prepared.exact.transitions.ofFace.empty()) igm::addChartJumps(map, prepared, result);
  });
  steps.finish();
  return result;
}

}  // namespace hexhex
