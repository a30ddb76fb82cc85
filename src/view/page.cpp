// The page: the template with title, a JSON text, and the packed mesh.
#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>
#include <view/mesh_tables.hpp>
#include <view/page_template.hpp>

#include <hexhex/error.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>
#include <hexhex/version.hpp>
#include <hexhex/view.hpp>

#include <base/parallel.hpp>
#include <io/output_file.hpp>

namespace hexhex {
namespace {

/// Textures of 4096 by 4096 texels, which phones have, too; and their memory ends about here.
constexpr std::size_t kMostElements = (std::size_t{1} << 24U) - 1;

/// Packed mesh and JSON text: all of the page that depends on the mesh.
// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON does not throw, however it is declared.
struct PageContent {
  nlohmann::json info;
  std::vector<PackedTable> tables;
};

void requireShowable(const HexMesh& mesh, const ViewOptions& options) {
  if (mesh.cells.empty()) {
    throw Error(ErrorCode::EmptyMesh, "The mesh has no cells: there is nothing to show.");
  }
  if (std::max(mesh.cells.size(), mesh.points.size()) > kMostElements) {
    throw Error(ErrorCode::TooLarge,
                "The mesh has " + std::to_string(mesh.cells.size()) + " cells and " +
                    std::to_string(mesh.points.size()) +
                    " vertices, but browsers do not hold more than 16 million. Extract it with a "
                    "smaller scale to look at it, or open it in ParaView.");
  }
  const std::size_t given = options.scaledJacobians.size();
  if (given != 0 && given != mesh.cells.size()) {
    throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(given) +
                                                " scaled Jacobians for " +
                                                std::to_string(mesh.cells.size()) + " cells.");
  }
  const std::size_t generators = mesh.generatorCorners.size();
  if (generators != 0 && generators != mesh.points.size()) {
    throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(generators) +
                                                " generators for " +
                                                std::to_string(mesh.points.size()) + " vertices.");
  }
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
                      {"chunkBytes", std::move(sizes)}});
  }
  return result;
}

PageContent makeContent(const HexMesh& mesh, const ViewOptions& options, Context& context) {
  requireShowable(mesh, options);
  const Quantization quantization = quantizationOf(mesh);
  const MeshStructure structure = findStructure(mesh, context);
  Array<double> quality(options.scaledJacobians.begin(), options.scaledJacobians.end());
  if (quality.empty()) quality = scaledJacobians(mesh, context);
  const QualitySummary summary = summarize(quality);

  PageContent content;
  withThreads(context.threads(), [&] {
    Stage stage(context, "pack mesh");
    content.tables = packMesh(mesh, quantization, quality, structure.singularEdges, stage);
  });
  content.info = {
      {"format", 1},
      {"title", options.title},
      {"program", "hexhex " HEXHEX_VERSION},
      {"vertices", mesh.points.size()},
      {"cells", mesh.cells.size()},
      {"lower", quantization.lower},
      {"upper", quantization.upper},
      {"step", quantization.step},
      {"quality",
       {{"minimum", summary.minimum},
        {"mean", summary.mean},
        {"notPositive", summary.notPositive}}},
      {"topology",
       {{"boundaryQuads", structure.boundaryQuads},
        {"boundaryComponents", structure.boundaryComponents},
        {"components", structure.components},
        {"eulerCharacteristic", structure.eulerCharacteristic}}},
      {"singular",
       {{"inner", countValences(structure, false)}, {"boundary", countValences(structure, true)}}},
      {"hasGenerators", !mesh.generatorCorners.empty()},
      {"verification", verificationAsJson(options)},
      {"tables", tablesAsJson(content.tables)}};
  return content;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else {
      result += c;
    }
  }
  return result;
}

/// JSON that may stand in a script element: nothing in it ends the element. Bytes that are no UTF-8
/// (in file names) are replaced.
std::string scriptText(const nlohmann::json& value) {
  const std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

/// All before the mesh. @param connect  what the page may connect to
std::string pageHead(const PageContent& content, const ViewOptions& options,
                     std::string_view connect) {
  const PageTemplate& page = *pageTemplate();
  std::string head(page.beforeConnect);
  head += connect;
  head += page.beforeTitle;
  head += escaped(options.title);
  head += page.beforeInfo;
  head += scriptText(content.info);
  head += page.beforeData;
  return head;
}

}  // namespace

void writeViewPage(const HexMesh& mesh, const std::filesystem::path& file,
                   const ViewOptions& options, Context& context) {
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const PageContent content = makeContent(mesh, options, context);
  const Stage stage(context, "write page");
  output.write(pageHead(content, options, "'none'"));
  for (const PackedTable& table : content.tables) {
    for (std::size_t chunk = 0; chunk < table.chunks.size(); ++chunk) {
      context.throwIfCancelled();
      output.write("<script type=\"application/octet-stream\" id=\"data-" + table.name + "-");
      output.write(chunk).write("\">").write(toBase64(table.chunks[chunk])).write("</script>\n");
    }
  }
  output.write(pageTemplate()->end);
  output.commit();
}

ServedPage makeServedPage(const HexMesh& mesh, const std::string& dataUrl,
                          const ViewOptions& options, Context& context) {
  PageContent content = makeContent(mesh, options, context);
  content.info["data"] = dataUrl;
  ServedPage served;
  served.html = pageHead(content, options, "'self'");
  served.html += pageTemplate()->end;
  for (PackedTable& table : content.tables) {
    for (std::string& chunk : table.chunks) served.data.push_back(std::move(chunk));
  }
  return served;
}

}  // namespace hexhex
