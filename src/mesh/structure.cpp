// The structure of a mesh, from its faces and edges.
#include <adjacency/hex_topology.hpp>

#include <hexhex/structure.hpp>

#include <base/parallel.hpp>

namespace hexhex {

MeshStructure findStructure(const HexMesh& mesh, Context& context) {
  return inStage(context, "findStructure", "structure", [&](Stage& stage) {
    MeshStructure result;
    withThreads(context.threads(), [&] {
      const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh, stage);
      const adjacency::HexFaces faces = adjacency::findFaces(mesh, around, stage);
      adjacency::HexEdges edges = adjacency::findEdges(mesh, around, faces, stage);
      result.singularEdges = std::move(edges.singular);
      result.faces = faces.count;
      result.edges = edges.count;
      result.boundaryQuads = faces.boundaryCount;
      result.components = faces.components;
      result.boundaryComponents = edges.boundaryComponents;
      result.eulerCharacteristic = adjacency::eulerCharacteristic(mesh, faces, edges);
    });
    return result;
  });
}

}  // namespace hexhex
