#include <cmath>

#include <hexhex/map_structure.hpp>

#include <base/parallel.hpp>
#include <igm/prepare.hpp>

namespace hexhex {
namespace {

using Matrix = std::array<std::array<std::int8_t, 3>, 3>;

/// A rotation between charts of the pipeline, between those of the caller: all charts of the former
/// have the first parameter negated if the map is mirrored.
Matrix matrixOf(const Rotation& rotation, bool mirrored) {
  Matrix matrix{};
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

/// The integers nearest to what is left of the parameters of the face's corners after the rotation.
/// (The pipeline has moved charts towards the origin; here they are the caller's.)
std::array<double, 3> translationOf(const TetMapView& map, const ChartJump& jump) {
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
      sum[row] += u[1][row] - (r[0] * u[0][0] + r[1] * u[0][1] + r[2] * u[0][2]);
    }
  }
  for (double& component : sum) component = std::nearbyint(component / 3) + 0.0;  // no -0
  return sum;
}

bool isIdentity(const ChartJump& jump) {
  constexpr Matrix kIdentity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return jump.rotation == kIdentity && jump.translation == std::array<double, 3>{};
}

void addChartJumps(const TetMapView& map, const PreparedMap& prepared, MapStructure& result) {
  const TetTopology& topology = prepared.topology;
  const Transitions& transitions = prepared.exact.transitions;
  for (HalfFace face = 0; face < topology.mate.size(); ++face) {
    const HalfFace mate = topology.mate[face];
    if (mate == kNone || tetOf(mate) < tetOf(face)) continue;
    ChartJump jump;
    jump.tets = {tetOf(face), tetOf(mate)};
    std::size_t next = 0;
    for (const Index vertex : map.tets[tetOf(face)]) {
      if (vertex != topology.vertex(face)) jump.vertices[next++] = vertex;
    }
    jump.rotation = matrixOf(transitions.across(face).rotation, prepared.input.mirrored);
    jump.translation = translationOf(map, jump);
    if (!isIdentity(jump)) result.chartJumps.push_back(jump);
  }
}

}  // namespace

MapStructure findMapStructure(const TetMapView& map, double tolerance, Context& context) {
  MapStructure result;
  withThreads(context.threads(), [&] {
    DefectCollector defects;
    const PreparedMap prepared = prepareMap(map, tolerance, 1, context, defects);
    result.defects = defects.defects();
    const Stage stage(context, "map structure");
    for (const SingularEdge& edge : prepared.singularities.edges) {
      result.singularEdges.push_back({edge.vertex0, edge.vertex1, edge.valence, edge.boundary});
    }
    if (!prepared.exact.transitions.ofFace.empty()) addChartJumps(map, prepared, result);
  });
  return result;
}

}  // namespace hexhex
