// Gmsh's files of Lagrange cells.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <base/parallel.hpp>
#include <io/curved/lagrange_files.hpp>
#include <io/curved/lagrange_nodes.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/gmsh/msh41_writer.hpp>

namespace hexhex {
namespace {

// Gmsh's types of elements of order 1 to 9.
constexpr std::array<unsigned, kMaxOrder> kLines = {1, 8, 26, 27, 28, 62, 63, 64, 65};
constexpr std::array<unsigned, kMaxOrder> kQuads = {3, 10, 36, 37, 38, 47, 48, 49, 50};
constexpr std::array<unsigned, kMaxOrder> kHexahedra = {5, 12, 92, 93, 94, 95, 96, 97, 98};

/// The nodes of a cell in the order of a file.
struct NodesInOrder {
  const Index* nodes;
  const std::uint32_t* order;

  Index operator[](std::size_t k) const { return nodes[order[k]]; }
};

}  // namespace

void writeLagrangeGmsh(const LagrangeMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  // First, so that a folder that is not writable shows at once.
  Msh41Writer<TextNumbers> writer(file, context.threads());
  HexMesh straight = straightMesh(mesh);
  const GmshGroups groups(MeshGroups(straight, options.patchAngle, stage, context.threads()));
  Array<Index> lines;
  Array<Index> quads;
  withThreads(context.threads(), [&] {
    lines = gmshEdgeNodes(mesh, straight, groups.edges, stage);
    quads = gmshQuadNodes(mesh, straight, groups.quads, stage);
  });
  straight = {};

  const std::vector<std::uint32_t> order = gmshNodeOrder(mesh.order);
  const std::size_t perEdge = static_cast<std::size_t>(mesh.order) + 1;
  const std::size_t perQuad = perEdge * perEdge;
  const std::size_t type = perEdge - 2;
  const auto forEachKind = [&](const auto& f) {
    f(GmshKind{0U, kGmshPoint, 1U, [&](std::size_t i) { return groups.vertices.elements[i]; }});
    f(GmshKind{1U, kLines[type], perEdge,
               [&](std::size_t i) { return lines.data() + i * perEdge; }});
    f(GmshKind{2U, kQuads[type], perQuad,
               [&](std::size_t i) { return quads.data() + i * perQuad; }});
    f(GmshKind{
        3U, kHexahedra[type], order.size(), [&](std::size_t i) {
          return NodesInOrder{mesh.nodes.data() + groups.cells.at(i) * order.size(), order.data()};
        }});
  };
  writer.write(mesh.points, groups, forEachKind, stage);
}

}  // namespace hexhex
