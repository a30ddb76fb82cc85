#include <extract/generator_ids.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

/// Faces are numbered by (smaller tet, corner opposite): per tet, the number of its first face.
Array<Index> numberFaces(const TetTopology& topology, Stage& stage) {
  Array<Index> begin(topology.tetCount() + 1);
  begin[topology.tetCount()] = 0;
  parallelFor(stage, topology.tetCount(), kGrain, [&](std::size_t t) {
    Index owned = 0;
    for (int face = 0; face < 4; ++face) {
      const HalfFace mate = topology.mate[halfFaceOf(static_cast<Index>(t), face)];
      if (mate == kNone || tetOf(mate) > t) ++owned;
    }
    begin[t] = owned;
  });
  exclusiveScan(std::span(begin));
  return begin;
}

}  // namespace

void describeGenerators(const PreparedMap& map, const HexVertices& vertices, HexMesh& mesh,
                        Stage& stage) {
  const TetTopology& topology = map.topology;
  const Array<Index> faceBegin = numberFaces(topology, stage);
  const auto faceIndex = [&](Index tet, int face) {
    Index index = faceBegin[tet];
    for (int callers = 0; callers < map.input.callersCorner(face); ++callers) {
      const HalfFace mate = topology.mate[halfFaceOf(tet, map.input.callersCorner(callers))];
      if (mate == kNone || tetOf(mate) > tet) ++index;
    }
    return index;
  };
  const auto indexOf = [&](const Generator& generator) -> Index {
    const std::size_t low = firstCorner(generator.simplex);
    const std::size_t high = lastCorner(generator.simplex);
    const Tet& tet = topology.tets[generator.tet];
    switch (generator.kind()) {
      case GeneratorKind::Vertex:
        return tet[low];
      case GeneratorKind::Edge:
        return static_cast<Index>(topology.edgeIndex(tet[low], tet[high]));
      case GeneratorKind::Face:
        return faceIndex(generator.tet, oppositeCorner(generator.simplex));
      case GeneratorKind::Cell:
        return generator.tet;
    }
    return kNone;
  };
  mesh.generatorKind.resize(vertices.positions.size());
  mesh.generatorIndex.resize(vertices.positions.size());
  mesh.generatorTet.resize(vertices.positions.size());
  parallelFor(stage, vertices.generators.size(), kGrain, [&](std::size_t g) {
    const Generator& generator = vertices.generators[g];
    const Index index = indexOf(generator);
    for (Index v = generator.firstVertex; v < generator.firstVertex + generator.vertexCount; ++v) {
      mesh.generatorKind[v] = generator.kind();
      mesh.generatorIndex[v] = index;
      mesh.generatorTet[v] = generator.tet;
    }
  });
}

}  // namespace hexhex
