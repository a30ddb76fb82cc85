// What is expected of a mesh follows from check(), which knows nothing of extraction. What is known
// about the faces, edges and vertices of a mesh becomes a list of comparisons.
//
// A cell with repeated vertices is no fault in itself: where a map is coarse, a cell may well meet
// itself. It shows in the counts if it is wrong.
#include <algorithm>
#include <string>
#include <utility>

#include <adjacency/hex_topology.hpp>

#include <hexhex/check.hpp>
#include <hexhex/verify.hpp>

#include <base/parallel.hpp>
#include <mesh/verify_against.hpp>

namespace hexhex {
namespace {

/// Rounding of interpolated parameters, in hex edges: far above what double precision causes, far
/// below any real error.
constexpr double kRounding = 1e-6;

/// Collects comparisons.
class Comparisons {
 public:
  void add(std::string name, std::string expected, std::string found, bool passed) {
    report_.items.push_back({std::move(name), std::move(expected), std::move(found), passed});
  }

  template <class Number>
  void addEqual(const char* name, Number expected, Number found) {
    add(name, std::to_string(expected), std::to_string(found), expected == found);
  }

  /// Something that must not occur. @param first  where it does, in words
  void addNone(const char* name, std::uint64_t count, const std::string& first) {
    add(name, "0", count == 0 ? "0" : std::to_string(count) + " (first: " + first + ")",
        count == 0);
  }

  void setAmbiguous(bool ambiguous) { report_.ambiguous = ambiguous; }

  [[nodiscard]] VerifyReport take() { return std::move(report_); }

 private:
  VerifyReport report_;
};

/// "3:76 5:4", or "none".
std::string toText(const std::map<int, std::uint64_t>& countsByValence) {
  std::string text;
  for (const auto& [valence, count] : countsByValence) {
    if (!text.empty()) text += ' ';
    text += std::to_string(valence) + ':' + std::to_string(count);
  }
  return text.empty() ? "none" : text;
}

/// The same without valences that do not occur.
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

std::string vertexName(Index vertex) { return "vertex " + std::to_string(vertex); }
std::string cellName(std::size_t cell) { return "cell " + std::to_string(cell); }

/// "cell 3, vertices 1 4 9 7"
std::string faceName(const HexMesh& mesh, const CellFace<Hex>& face) {
  if (face.cell == kNone) return "";
  std::string text = cellName(face.cell) + ", vertices";
  for (const Index v : faceVertices(mesh.cells[face.cell], face.face)) {
    text += ' ' + std::to_string(v);
  }
  return text;
}

std::string edgeName(const MeshEdge& edge) {
  return "edge " + std::to_string(edge.vertex0) + '-' + std::to_string(edge.vertex1);
}

/// Adds "indices_in_range"; returns whether it passed.
bool compareIndices(const HexMesh& mesh, Stage& stage, Comparisons& comparisons) {
  const std::size_t bad = firstCellOutOfRange(mesh, stage);
  const bool inRange = bad == mesh.cells.size();
  comparisons.add("indices_in_range", "yes", inRange ? "yes" : "no (first: " + cellName(bad) + ")",
                  inRange);
  return inRange;
}

/// The number of edges, and the corners of cells at them.
struct EdgeSum {
  std::uint64_t edges = 0;
  std::uint64_t corners = 0;
  explicit EdgeSum(const std::map<int, std::uint64_t>& countsByValence) {
    for (const auto& [valence, count] : countsByValence) {
      edges += count;
      corners += count * static_cast<std::uint64_t>(valence);
    }
  }
};

/// Whether there are fewer edges or faces than the cells of the map have, and all vertices.
bool isAmbiguous(const Expectation& expected, const HexMesh& mesh, const HexFaces& faces,
                 const HexEdges& edges) {
  const EdgeSum inner(expected.innerSingularEdges);
  const EdgeSum boundary(expected.boundarySingularEdges);
  const std::uint64_t regularBoundary = 2 * expected.boundaryQuads - boundary.edges;
  const std::uint64_t regularInner =
      (12 * expected.cells - inner.corners - boundary.corners - 2 * regularBoundary) / 4;
  const std::uint64_t allEdges = inner.edges + boundary.edges + regularBoundary + regularInner;
  const std::uint64_t allFaces = (6 * expected.cells + expected.boundaryQuads) / 2;
  const auto vertices = static_cast<std::uint64_t>(expected.eulerCharacteristic) + allEdges +
                        expected.cells - allFaces;
  return mesh.cells.size() == expected.cells && faces.usedVertices == vertices &&
         edges.count <= allEdges && faces.count <= allFaces &&
         edges.count + faces.count < allEdges + allFaces;
}

void compareTopology(const Expectation& expected, const HexMesh& mesh, Stage& stage,
                     Comparisons& comparisons) {
  const VertexCells around = cellsAroundVertices(mesh, stage);
  const HexFaces faces = findFaces(mesh, around, stage);
  const HexEdges edges = findEdges(mesh, around, faces, stage);

  comparisons.addEqual<std::uint64_t>("cells", expected.cells, mesh.cells.size());
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
                       eulerCharacteristic(mesh, faces, edges));
  comparisons.addEqual("components", expected.components, faces.components);
  comparisons.add("boundary_closed", "yes",
                  edges.openCount == 0 ? "yes" : "no (first: " + edgeName(edges.firstOpen) + ")",
                  edges.openCount == 0);
  comparisons.addEqual("boundary_components", expected.boundaryComponents,
                       edges.boundaryComponents);
  comparisons.addNone("unused_vertices", mesh.points.size() - faces.usedVertices,
                      vertexName(faces.firstUnusedVertex));
  comparisons.setAmbiguous(isAmbiguous(expected, mesh, faces, edges));
}

void comparePositions(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options,
                      Stage& stage, Comparisons& comparisons) {
  // Vertices were placed with parameters of which each may have been moved by `tolerance`, and so
  // may what is interpolated between them; scaling enlarges that. It is not capped: for a large
  // scale of a very inexact map nothing can be said about positions, but neither is the mesh wrong.
  const double allowed = options.scale * options.tolerance + kRounding;
  const OffLattice off = findOffLattice(map, mesh, options.scale, allowed, stage);
  const std::string where =
      off.outside ? " is outside of all tets"
                  : " is " + std::to_string(off.distance) + " hex edges off the lattice";
  comparisons.addNone("vertices_off_lattice", off.count, vertexName(off.first) + where);
}

/// "2 defects, first: FlippedTet, tet 7"
std::string describe(const std::vector<Defect>& defects) {
  std::string text = "no: " + std::string(name(defects.front().code));
  const auto& worst = defects.front().worst;
  const std::string place = worst.empty() ? "" : toString(worst.front().place);
  if (!place.empty()) text += " at " + place;
  const std::size_t more = defects.size() - 1;
  if (more > 0) text += ", and " + std::to_string(more) + " more kinds of defects";
  return text;
}

}  // namespace

VerifyReport verifyAgainst(const Expectation& expected, const TetMapView& map, const HexMesh& mesh,
                           const VerifyOptions& options, Stage& stage) {
  Comparisons comparisons;
  if (compareIndices(mesh, stage, comparisons)) {
    compareTopology(expected, mesh, stage, comparisons);
    comparePositions(map, mesh, options, stage, comparisons);
  }
  return comparisons.take();
}

VerifyReport verify(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options,
                    Context& context) {
  const CheckReport report = check(map, {options.tolerance, options.scale}, context);
  if (!report.valid()) return {{{"map_valid", "yes", describe(report.defects), false}}};

  // Positions need not be looser than what sanitization really did to the parameters.
  VerifyOptions tightened = options;
  tightened.tolerance = std::min(options.tolerance, report.maxDisplacement);
  VerifyReport result;
  withThreads(context.threads(), [&] {
    Stage stage(context, "verification");
    result = verifyAgainst(report.expected, map, mesh, tightened, stage);
  });
  result.items.insert(result.items.begin(), {"map_valid", "yes", "yes", true});
  return result;
}

VerifyReport verify(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options) {
  Context context;
  return verify(map, mesh, options, context);
}

}  // namespace hexhex
