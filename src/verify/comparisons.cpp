#include <algorithm>
#include <map>
#include <string>

#include <adjacency/hex_topology.hpp>
#include <verify/comparisons.hpp>
#include <verify/proof.hpp>

namespace hexhex::verification {

namespace {

/// "3:76 5:4", or "none".
std::string toText(const std::map<int, std::uint64_t>& countsByValence) {
  std::string text;
  for (const auto& [valence, count] : countsByValence) {
    if (!text.empty()) text += ' ';
    text += std::to_string(valence) + ':' + std::to_string(count);
  }
  return text.empty() ? "none" : text;
}

/// The counts without valences that do not occur.
std::map<int, std::uint64_t> withoutZeros(std::map<int, std::uint64_t> counts) {
  std::erase_if(counts, [](const auto& entry) { return entry.second == 0; });
  return counts;
}

void compareValences(const char* name, const std::map<int, std::uint64_t>& expected,
                     const std::map<int, std::uint64_t>& found, Comparisons& comparisons) {
  const std::string expectedText = toText(withoutZeros(expected));
  const std::string foundText = toText(found);
  comparisons.add(name, expectedText, foundText, expectedText == foundText);
}

/// "cell 3, vertices 1 4 9 7"
std::string faceName(const HexMesh& mesh, const adjacency::CellFace<Hex>& face) {
  if (face.cell == kNone) return "";
  std::string text = cellName(face.cell) + ", vertices";
  for (const Index v : adjacency::faceVertices(mesh.cells[face.cell], face.face)) {
    text += ' ' + std::to_string(v);
  }
  return text;
}

std::string edgeName(const adjacency::MeshEdge& edge) {
  return "edge " + std::to_string(edge.vertex0) + '-' + std::to_string(edge.vertex1);
}

}  // namespace

void compareSums(const Expectation& expected, const HexMesh& mesh, Stage& stage,
                 Comparisons& comparisons) {
  const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh, stage);
  const adjacency::HexFaces faces = adjacency::findFaces(mesh, around, stage);
  const adjacency::HexEdges edges = adjacency::findEdges(mesh, around, faces, stage);
  const ExpectedElements all = expectedElements(expected);
  if (mesh.cells.size() == expected.cells && faces.usedVertices == all.vertices &&
      edges.count <= all.edges && faces.count <= all.faces &&
      edges.count + faces.count < all.edges + all.faces) {
    comparisons.add("faces_and_edges", "distinct", "some have the same vertices: not counted",
                    true);
    return;
  }

  comparisons.addEqual("boundary_quads", expected.boundaryQuads, faces.boundaryCount);
  compareValences("inner_singular_edges", expected.innerSingularEdges, edges.innerSingular,
                  comparisons);
  compareValences("boundary_singular_edges", expected.boundarySingularEdges, edges.boundarySingular,
                  comparisons);
  comparisons.addNone("faces_shared_by_more_than_two_cells", faces.overfull.count,
                      faceName(mesh, faces.overfull.first));
  comparisons.addNone("faces_with_wrong_direction", faces.sameDirection.count,
                      faceName(mesh, faces.sameDirection.first));
  comparisons.addEqual("euler_characteristic", expected.eulerCharacteristic,
                       adjacency::eulerCharacteristic(mesh, faces, edges));
  comparisons.addEqual("components", expected.components, faces.components);
  comparisons.add("boundary_closed", "yes",
                  edges.openCount == 0 ? "yes" : "no (first: " + edgeName(edges.firstOpen) + ")",
                  edges.openCount == 0);
  comparisons.addEqual("boundary_components", expected.boundaryComponents,
                       edges.boundaryComponents);
}

}  // namespace hexhex::verification
