#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <quantize/bend/edge_turns.hpp>
#include <quantize/quantized_map.hpp>
#include <tetmap/carried_tags.hpp>

#include <hexhex/check.hpp>

#include <base/vector3.hpp>
#include <igm/defects.hpp>

namespace hexhex::quantization {

namespace {

/// The scaled Jacobian of the inverse map of a tet, that is, of the image of a small cube in space.
double inverseJacobian(const std::array<Vec3, 4>& points, const TetParameters& u) {
  std::array<Vec3, 3> x{};
  std::array<Vec3, 3> p{};
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = minus(points[i + 1], points[0]);
    p[i] = minus(u[i + 1], u[0]);
  }
  // The columns of X P^-1, up to the factor det P.
  const std::array<Vec3, 3> rows = {cross(p[1], p[2]), cross(p[2], p[0]), cross(p[0], p[1])};
  std::array<Vec3, 3> columns{};
  double product = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) columns[k][j] += x[i][j] * rows[i][k];
    }
    product *= std::sqrt(dot(columns[k], columns[k]));
  }
  return product > 0 ? tripleProduct(columns[0], columns[1], columns[2]) / product : 0;
}

}  // namespace

MapDistortion distortionOf(const std::vector<Vec3>& points, const std::vector<Tet>& tets,
                           const std::vector<TetParameters>& parameters) {
  std::vector<double> values(tets.size());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    std::array<Vec3, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = points[tets[t][i]];
    values[t] = inverseJacobian(corners, parameters[t]);
  }
  MapDistortion distortion;
  distortion.worst = *std::min_element(values.begin(), values.end());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  distortion.median = *middle;
  return distortion;
}

namespace {

/// @throws Error Internal if the singular curves have changed
void requireSingularities(const IrregularEdges& expected, const TetMap& map, Context& context) {
  Stage stage(context, "singular curves");
  auto topology = adjacency::manifoldTopology(map.tets, map.points.size(), stage);
  if (!topology) {
    throw Error(ErrorCode::Internal, "Quantization has made a mesh that is no manifold.");
  }
  adjacency::addStars(*topology, stage);
  const adjacency::EdgeFans edges(*topology);
  const std::span<const TetParameters> parameters = map.parameters;
  if (irregularEdges(edges, topology->tets, parameters) != expected) {
    throw Error(ErrorCode::Internal,
                "Quantization has changed singular curves of the map. This is a bug.");
  }
}

}  // namespace

QuantizedMap finishQuantization(FoundMap found, const TetMapView& given, Context& context) {
  BentMap& bent = found.bent;
  QuantizedMap result;
  result.report = found.report;
  result.report.distortionAfter = distortionOf(bent.points, bent.tets, bent.parameters);
  result.report.distortionBefore = distortionOf(bent.points, bent.tets, bent.reference);
  std::vector<TetParameters>().swap(bent.reference);
  TetMap& map = result.map;
  tetmap::AddedVertices added(given.points.size());
  for (std::size_t s = 0; s < bent.splitEdges.size(); ++s) {
    const auto middle = static_cast<Index>(given.points.size() + s);
    splitIrregular(bent.splitEdges[s], middle, found.irregularEdges);
    added.add(bent.splitEdges[s]);
  }
  map.points = std::move(bent.points);
  map.tets = std::move(bent.tets);
  map.parameters = std::move(bent.parameters);
  tetmap::carryTags(given.features, given.regions, added, bent.parentTet, map);
  const CheckReport checked = check(map, {.tolerance = 0}, context);
  if (!checked.valid()) {
    throw Error(ErrorCode::Internal, "Quantization has made a map that is not valid (" +
                                         std::string(name(checked.defects.front().code)) +
                                         "). This is a bug.");
  }
  requireSingularities(found.irregularEdges, map, context);
  return result;
}

}  // namespace hexhex::quantization
