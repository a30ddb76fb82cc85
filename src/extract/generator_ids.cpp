#include <extract/generator_ids.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

/// A simplex of a tet in terms of the caller's order of corners.
CornerSet callersCorners(const OrientedMap& input, CornerMask simplex) {
  CornerSet corners = 0;
  for (int i = 0; i < 4; ++i) {
    if (contains(simplex, i)) {
      corners = static_cast<CornerSet>(corners | cornerBit(input.callersCorner(i)));
    }
  }
  return corners;
}

}  // namespace

void describeGenerators(const PreparedMap& map, const HexVertices& vertices, HexMesh& mesh,
                        Stage& stage) {
  mesh.generatorTet.resize(vertices.positions.size());
  mesh.generatorCorners.resize(vertices.positions.size());
  parallelFor(stage, vertices.generators.size(), kGrain, [&](std::size_t g) {
    const Generator& generator = vertices.generators[g];
    const CornerSet corners = callersCorners(map.input, generator.simplex);
    for (Index v = generator.firstVertex; v < generator.firstVertex + generator.vertexCount; ++v) {
      mesh.generatorTet[v] = generator.tet;
      mesh.generatorCorners[v] = corners;
    }
  });
}

}  // namespace hexhex
