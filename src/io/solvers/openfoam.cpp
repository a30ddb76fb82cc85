#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/text_scanner.hpp>
#include <io/solvers/poly_mesh.hpp>
#include <io/solvers/solvers.hpp>

namespace hexhex::io {
namespace {

constexpr std::size_t kOpenfoamGrain = 4096;

/// Inner faces: those of each cell with larger neighbours, in order of the neighbours.
void addInnerFaces(const HexMesh& mesh, PolyMesh& poly, Stage& stage) {
  const adjacency::FaceNeighbours neighbours = adjacency::findFaceNeighbours(mesh, stage);
  const auto isOwned = [&neighbours](std::size_t cell, std::size_t face) {
    const Index other = neighbours[cell][face];
    return other != kNone && other > cell;
  };
  Array<std::uint64_t> begin(mesh.cells.size() + 1);
  begin[mesh.cells.size()] = 0;
  parallelFor(stage, mesh.cells.size(), kOpenfoamGrain, [&](std::size_t c) {
    begin[c] = 0;
    for (std::size_t face = 0; face < 6; ++face) begin[c] += isOwned(c, face) ? 1 : 0;
  });
  const std::uint64_t count = exclusiveScan(std::span(begin));
  poly.faces.resize(count);
  poly.owners.resize(count);
  poly.neighbours.resize(count);
  parallelFor(stage, mesh.cells.size(), kOpenfoamGrain, [&](std::size_t c) {
    std::array<std::pair<Index, std::size_t>, 6> owned{};  // neighbours and faces, ascending
    std::size_t size = 0;
    for (std::size_t face = 0; face < 6; ++face) {
      if (isOwned(c, face)) owned[size++] = {neighbours[c][face], face};
    }
    std::sort(owned.begin(), owned.begin() + size);
    for (std::size_t i = 0; i < size; ++i) {
      poly.faces[begin[c] + i] = adjacency::faceVertices(mesh.cells[c], owned[i].second);
      poly.owners[begin[c] + i] = static_cast<Index>(c);
      poly.neighbours[begin[c] + i] = owned[i].first;
    }
  });
}

/// Boundary faces, group by group.
void addPatches(const QuadGroups& quads, PolyMesh& poly) {
  for (const ElementGroup& group : quads.groups) {
    const std::size_t begin = poly.faces.size();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      if (quads.places[i] == kNoPlace) continue;
      poly.faces.push_back(quads.elements[i]);
      poly.owners.push_back(static_cast<Index>(quads.places[i] / 8));
    }
    if (poly.faces.size() > begin)
      poly.patches.push_back({group.name, begin, poly.faces.size(), {}});
  }
}

bool isMarker(const std::filesystem::path& file) { return lowerCaseExtension(file) == ".foam"; }

}  // namespace

void writeOpenFoam(const HexMesh& mesh, const std::filesystem::path& file,
                   const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  // First, so that what is not writable shows at once.
  OutputFolder folder(isMarker(file) ? file.parent_path() / "constant" / "polyMesh" : file);
  std::optional<OutputFile> marker;
  if (isMarker(file)) marker.emplace(file);
  QuadGroups quads;
  PolyMesh poly;
  withThreads(context.threads(), [&] {
    quads = groupQuads(mesh, options.patchAngle, stage);
    addInnerFaces(mesh, poly, stage);
  });
  addPatches(quads, poly);
  requireInt32(mesh.points.size(), "OpenFOAM numbers vertices");
  requireInt32(poly.faces.size(), "OpenFOAM numbers faces");
  try {
    PolyMeshWriter writer(folder.temporary(), context.threads());
    writer.write(mesh, poly, stage);
    writer.writeBoundary(poly.patches);
    // Without regions there are no zones, which has to be said where an earlier mesh had some.
    writer.writeZones(mesh.regions.empty() ? CellGroups{} : groupCells(mesh));
    writer.commit();
  } catch (const Error& error) {
    throw folder.named(error);
  }
  folder.commit();
  if (!marker) return;
  try {
    marker->commit();
  } catch (...) {
    if (!marker->isNamed()) folder.takeBack();
    throw;
  }
}

}  // namespace hexhex::io
