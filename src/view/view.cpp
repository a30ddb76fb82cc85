// The page: the template filled with a title, a JSON text, and the packed mesh.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/version.hpp>
#include <hexhex/view.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <view/cut_tets.hpp>
#include <view/mesh_tables.hpp>
#include <view/page_template.hpp>

namespace hexhex::view {
namespace {

/// Textures of 4096 by 4096 texels, which phones support; their memory ends about here, too.
constexpr std::size_t kMostElements = (std::size_t{1} << 24U) - 1;

/// Limit of node numbers: half a gigabyte in a browser.
constexpr std::size_t kMostNodeNumbers = std::size_t{1} << 27U;

/// Packed mesh and JSON text: everything on the page that depends on the mesh.
// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON does not throw, however it is declared.
struct PageContent {
  nlohmann::json info;
  std::vector<PackedTable> tables;
};

/// The displayed mesh: the straight one between the corners, and how its faces bend.
struct Subject {
  const HexMesh& mesh;
  const SurfaceNodes& nodes;
  StateBefore before = {};
  bool isCutPart = false;  ///< cut tets, whose singular edges say nothing
};

struct CutPart {
  HexMesh mesh;
};

void requireSize(const Subject& subject) {
  const HexMesh& mesh = subject.mesh;
  if (mesh.cells.empty()) {
    throw Error(ErrorCode::EmptyMesh, "The mesh has no cells: there is nothing to show.");
  }
  const std::size_t points = mesh.points.size() + subject.nodes.points.size();
  if (std::max(mesh.cells.size(), points) <= kMostElements &&
      subject.nodes.numbers.size() <= kMostNodeNumbers) {
    return;
  }
  throw Error(
      ErrorCode::TooLarge,
      "The mesh has " + std::to_string(mesh.cells.size()) + " cells of order " +
          std::to_string(subject.nodes.order) + " and " + std::to_string(points) +
          " vertices and nodes on faces, but browsers do not hold more than 16 million. "
          "Extract it with a smaller scale or order to look at it, or open it in ParaView.");
}

void requireOnePer(const char* what, std::size_t given, const char* of, std::size_t wanted) {
  if (given == 0 || given == wanted) return;
  throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(given) + " " + what +
                                              " for " + std::to_string(wanted) + " " + of + ".");
}

void requireVertices(std::span<const Index> vertices, std::size_t count) {
  for (const Index vertex : vertices) {
    if (vertex < count) continue;
    throw Error(ErrorCode::InvalidArgument, "A tagged edge or quad names hex vertex " +
                                                std::to_string(vertex) + ", but there are " +
                                                std::to_string(count) + ".");
  }
}

void requireShowable(const Subject& subject, const ViewOptions& options) {
  requireSize(subject);
  const HexMesh& mesh = subject.mesh;
  requireOnePer("scaled Jacobians", options.scaledJacobians.size(), "cells", mesh.cells.size());
  for (std::size_t c = 0; c < options.scaledJacobians.size(); ++c) {
    if (std::isfinite(options.scaledJacobians[c])) continue;
    throw Error(ErrorCode::NotFinite,
                "The scaled Jacobian of cell " + std::to_string(c) + " is no finite number.",
                {PlaceKind::Cell, c, 0});
  }
  requireOnePer("generators", mesh.generatorCorners.size(), "vertices", mesh.points.size());
  requireOnePer("regions", mesh.regions.size(), "cells", mesh.cells.size());
  for (const auto& edge : mesh.features.edges) requireVertices(edge.vertices, mesh.points.size());
  for (const auto& quad : mesh.features.quads) requireVertices(quad.vertices, mesh.points.size());
}

/// [[valence, number of edges], ...]
nlohmann::json countValences(const MeshStructure& structure, bool boundary) {
  std::map<std::uint32_t, std::uint64_t> counts;
  for (const SingularHexEdge& edge : structure.singularEdges) {
    if (edge.boundary == boundary) ++counts[edge.valence];
  }
  nlohmann::json result = nlohmann::json::array();
  for (const auto& [valence, count] : counts) result.push_back({valence, count});
  return result;
}

nlohmann::json verificationAsJson(const ViewOptions& options) {
  if (options.verification == nullptr) return nullptr;
  nlohmann::json items = nlohmann::json::array();
  for (const VerifyItem& item : options.verification->items) {
    items.push_back({{"name", item.name},
                     {"expected", item.expected},
                     {"found", item.found},
                     {"passed", item.passed}});
  }
  return {{"map", options.mapName},
          {"passed", options.verification->passed()},
          {"items", std::move(items)}};
}

nlohmann::json tablesAsJson(const std::vector<PackedTable>& tables) {
  nlohmann::json result = nlohmann::json::array();
  for (const PackedTable& table : tables) {
    nlohmann::json sizes = nlohmann::json::array();
    for (const std::string& chunk : table.chunks) sizes.push_back(chunk.size());
    result.push_back({{"name", table.name},
                      {"rows", table.rows},
                      {"columns", table.columns},
                      {"rowsPerChunk", table.rowsPerChunk},
                      {"byRows", table.byRows},
                      {"chunkBytes", std::move(sizes)}});
  }
  return result;
}

nlohmann::json validityAsJson(const Certificate& certificate) {
  nlohmann::json worst = nlohmann::json::array();
  for (const RefutedCell& bad : certificate.worst) {
    worst.push_back(
        {{"cell", bad.cell}, {"place", bad.place}, {"scaledJacobian", bad.scaledJacobian}});
  }
  return {{"refuted", certificate.refuted},
          {"undecided", certificate.undecided},
          {"minimum", certificate.minimum},
          {"worst", std::move(worst)}};
}

nlohmann::json qualityAsJson(const QualitySummary& summary) {
  return {
      {"minimum", summary.minimum}, {"mean", summary.mean}, {"notPositive", summary.notPositive}};
}

std::vector<Index> notPositive(const Certificate& certificate) {
  std::vector<Index> cells;
  if (certificate.allPositive()) return cells;
  for (std::size_t c = 0; c < certificate.validity.size(); ++c) {
    if (certificate.validity[c] != Validity::Positive) cells.push_back(static_cast<Index>(c));
  }
  return cells;
}

/// @param points  of the vertices  @param nodes  as SurfaceNodes::points
StateBefore stateBefore(std::span<const Vec3> points, std::span<const Vec3> nodes,
                        const Certificate& certificate) {
  return {points, nodes, {certificate.scaledJacobians, notPositive(certificate)}};
}

/// The groups of boundary quads that files get: their names, and which one each face of the
/// boundary is in, in order of (cell, face).
struct NamedSkin {
  nlohmann::json names = nlohmann::json::array();
  std::vector<std::uint32_t> groups;
};

NamedSkin namedSkin(const HexMesh& mesh, Stage& stage) {
  const io::QuadGroups quads = io::groupQuads(mesh, WriteOptions{}.patchAngle, stage);
  NamedSkin skin;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> faces;
  for (const io::ElementGroup& group : quads.groups) {
    const std::size_t end = quads.boundaryEnd(group);
    if (end == group.begin) continue;
    for (std::size_t i = group.begin; i < end; ++i) {
      faces.emplace_back(quads.places[i], static_cast<std::uint32_t>(skin.names.size()));
    }
    skin.names.push_back({{"name", group.name}, {"quads", end - group.begin}});
  }
  std::sort(faces.begin(), faces.end());
  for (const auto& [place, group] : faces) skin.groups.push_back(group);
  return skin;
}

/// @param before  certificate of subject.before, if that has points
PageContent makeContent(const Subject& subject, const Certificate& certificate,
                        const Certificate& before, const ViewOptions& options, Context& context) {
  Array<double> quality(options.scaledJacobians.begin(), options.scaledJacobians.end());
  if (quality.empty()) quality = certificate.scaledJacobians;
  const HexMesh& mesh = subject.mesh;
  const Quantization quantization = quantizationOf(mesh, subject.nodes, subject.before);
  MeshStructure structure = findStructure(mesh, context);
  if (subject.isCutPart) structure.singularEdges.clear();

  PageContent content;
  NamedSkin skin;
  withThreads(context.threads(), [&] {
    Stage stage(context, "pack mesh");
    skin = namedSkin(mesh, stage);
    content.tables =
        packMesh(mesh, quantization, {quality, notPositive(certificate)}, structure.singularEdges,
                 stage, subject.nodes, subject.before, skin.groups);
  });
  content.info = {
      {"format", 1},
      {"title", options.title},
      {"program", "hexhex " HEXHEX_VERSION},
      {"vertices", mesh.points.size()},
      {"points", mesh.points.size() + subject.nodes.points.size()},
      {"cells", mesh.cells.size()},
      {"order", subject.nodes.order},
      {"lower", quantization.lower},
      {"upper", quantization.upper},
      {"step", quantization.step},
      {"quality", qualityAsJson(summarize(quality))},
      {"validity", validityAsJson(certificate)},
      {"topology",
       {{"boundaryQuads", structure.boundaryQuads},
        {"boundaryComponents", structure.boundaryComponents},
        {"components", structure.components},
        {"eulerCharacteristic", structure.eulerCharacteristic}}},
      {"singular",
       {{"inner", countValences(structure, false)}, {"boundary", countValences(structure, true)}}},
      {"patches", std::move(skin.names)},
      {"hasGenerators", !mesh.generatorCorners.empty()},
      {"verification", verificationAsJson(options)},
      {"tables", tablesAsJson(content.tables)}};
  if (!subject.before.points.empty()) {
    content.info["before"] = {{"quality", qualityAsJson(before.quality)},
                              {"validity", validityAsJson(before)}};
  }
  return content;
}

PageContent makeContent(const HexMesh& mesh, const ViewOptions& options, Context& context) {
  const SurfaceNodes straight;
  requireShowable({mesh, straight}, options);
  requireOnePer("earlier positions", options.pointsBefore.size(), "vertices", mesh.points.size());
  Certificate before;
  if (!options.pointsBefore.empty()) {
    HexMesh earlier;
    earlier.points.assign(options.pointsBefore.begin(), options.pointsBefore.end());
    earlier.cells = mesh.cells;
    before = certify(earlier, context);
  }
  const Subject subject{mesh, straight, stateBefore(options.pointsBefore, {}, before)};
  return makeContent(subject, certify(mesh, context), before, options, context);
}

/// Direction from the middle of a part to its region at the place; any if there is none.
Vec3 sideOf(const HexMesh& mesh) {
  Vec3 sum{};
  std::size_t count = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (mesh.regions[c] != kAtPlace) continue;
    sum = plus(sum, mesh.points[mesh.cells[c][0]]);
    ++count;
  }
  if (count == 0) return {1, -1.6, 0.9};
  const Vec3 side = minus(times(1 / static_cast<double>(count), sum), centreOf(mesh.points));
  return dot(side, side) > 0 ? side : Vec3{1, -1.6, 0.9};
}

PageContent makeContent(const CutPart& part, const ViewOptions& options, Context& context) {
  const SurfaceNodes straight;
  const Subject subject{part.mesh, straight, {}, true};
  requireShowable(subject, options);
  PageContent content = makeContent(subject, certify(part.mesh, context), {}, options, context);
  content.info["start"] = {{"colour", "region"}, {"from", sideOf(part.mesh)}};
  return content;
}

PageContent makeContent(const LagrangeMesh& mesh, const ViewOptions& options, Context& context) {
  const SurfaceNodes nodes = surfaceNodesOf(mesh);
  const HexMesh corners = straightMesh(mesh);
  requireShowable({corners, nodes}, options);
  requireOnePer("earlier positions", options.pointsBefore.size(), "nodes", mesh.points.size());
  Certificate before;
  SurfaceNodes nodesBefore;
  std::span<const Vec3> verticesBefore;
  if (!options.pointsBefore.empty()) {
    LagrangeMesh earlier = mesh;
    earlier.points.assign(options.pointsBefore.begin(), options.pointsBefore.end());
    before = certify(earlier, context);
    nodesBefore = surfaceNodesOf(earlier);
    verticesBefore = options.pointsBefore.first(mesh.vertexCount);
  }
  const Subject subject{corners, nodes, stateBefore(verticesBefore, nodesBefore.points, before)};
  return makeContent(subject, certify(mesh, context), before, options, context);
}

std::string replaced(std::string_view text, char character, std::string_view by) {
  std::string result;
  for (const char c : text) {
    if (c == character) {
      result += by;
    } else {
      result += c;
    }
  }
  return result;
}

std::string escaped(std::string_view text) {
  return replaced(replaced(text, '&', "&amp;"), '<', "&lt;");
}

/// JSON for a script element: contains nothing that would end the element. Bytes that are not UTF-8
/// (in file names) are replaced.
std::string scriptText(const nlohmann::json& value) {
  return replaced(value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), '<',
                  "\\u003c");
}

/// Everything before the mesh.
std::string pageHead(const PageContent& content, const ViewOptions& options) {
  const PageTemplate& page = *pageTemplate();
  std::string head(page.beforeTitle);
  head += escaped(options.title);
  head += page.beforeInfo;
  head += scriptText(content.info);
  head += page.beforeData;
  return head;
}

constexpr std::array<WorkStep, 4> kPageSteps = {
    {{"certify", 0.5}, {"findStructure", 2}, {"pack mesh", 5}, {"write page", 3}}};

template <class Mesh>
void writePage(const Mesh& mesh, const std::filesystem::path& file, const ViewOptions& options,
               Context& context) {
  WorkSteps steps(context, "writeViewPage", kPageSteps);
  io::OutputFile output(file);  // first, so that an unwritable folder is noticed immediately
  const PageContent content = makeContent(mesh, options, context);
  const Stage stage(context, "write page");
  output.write(pageHead(content, options));
  for (const PackedTable& table : content.tables) {
    for (std::size_t chunk = 0; chunk < table.chunks.size(); ++chunk) {
      context.throwIfCancelled();
      output.write("<script type=\"application/octet-stream\" id=\"data-" + table.name + "-");
      output.write(chunk).write("\">").write(toBase64(table.chunks[chunk])).write("</script>\n");
    }
  }
  output.write(pageTemplate()->end);
  output.commit();
  steps.finish();
}

}  // namespace

}  // namespace hexhex::view

namespace hexhex {

void writeViewPage(const HexMesh& mesh, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context) {
  view::writePage(mesh, file, options, context);
}

void writeViewPage(const LagrangeMesh& mesh, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context) {
  view::writePage(mesh, file, options, context);
}

void writeViewPage(const TetMesh& part, const Place& place, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context) {
  // There are about 4.4 times as many vertices, edges, triangles and tets together.
  if (part.tets.size() > view::kMostElements / 22 * 5) {
    throw Error(ErrorCode::TooLarge,
                "The part has " + std::to_string(part.tets.size()) +
                    " tets, of four hexahedra each, but browsers do not hold more than 16 million "
                    "of these. Open it in ParaView.");
  }
  view::writePage(view::CutPart{view::cutTets(part, place)}, file, options, context);
}

}  // namespace hexhex
