#include <propeller/generator_ids.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

}  // namespace

void describeGenerators(const PreparedMap& map, const HexVertices& vertices, HexMesh& mesh,
                        Stage& stage) {
  mesh.generatorTet.resize(vertices.positions.size());
  mesh.generatorCorners.resize(vertices.positions.size());
  parallelFor(stage, vertices.generators.size(), kGrain, [&](std::size_t g) {
    const Generator& generator = vertices.generators[g];
    const CornerSet corners = map.input.callersCorners(generator.simplex);
    for (Index v = generator.firstVertex; v < generator.firstVertex + generator.vertexCount; ++v) {
      mesh.generatorTet[v] = generator.tet;
      mesh.generatorCorners[v] = corners;
    }
  });
}

}  // namespace hexhex
