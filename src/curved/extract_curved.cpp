// The public entries of curved meshes.
#include <string>

#include <hexhex/curved.hpp>

#include <curved/lagrange.hpp>
#include <extract/scaled_map.hpp>

namespace hexhex {

LagrangeMesh extractLagrange(const TetMapView& map, int order, const ExtractOptions& options,
                             Context& context, ExtractStatistics* statistics) {
  if (order < 1 || order > kMaxOrder) {
    throw Error(ErrorCode::InvalidArgument, "The order is " + std::to_string(order) +
                                                ". Choose one from 1 to " +
                                                std::to_string(kMaxOrder) + ".");
  }
  LagrangeMesh result;
  runExtraction(options, context, statistics, [&](ExtractStatistics& filled) {
    ScaledMap scaled = prepareScaled(map, options, {order}, context, filled);
    const HexMesh mesh = extractScaled(scaled, options, context, filled);
    result = groupNodes(mesh, scaled.map, order, context);
  });
  return result;
}

}  // namespace hexhex
