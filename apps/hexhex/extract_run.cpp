#include "extract_run.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/summary.hpp>
#include <hexhex/verify.hpp>

#include "improve_options.hpp"
#include "output.hpp"
#include "view_page.hpp"

namespace hexhex::command {
namespace {

/// The part of a run that makes, proves and writes a mesh in pieces.
constexpr std::string_view kInPieces = "extraction and writing";

}  // namespace

std::vector<WorkStep> extractionSteps(const ExtractArguments& arguments) {
  if (arguments.parts.parts) return {{"extractParts", 4}};
  if (arguments.stream) {
    return {{"Extractor", 0.3}, {"VerifySink", 0.1}, {"Extractor::extractTo", 6}};
  }
  return {{"Extractor", 0.3},
          {arguments.order > 1 ? "Extractor::extractLagrange" : "Extractor::extract", 4},
          {"Extractor::extractPiecewiseLinear", 20},
          {"Extractor::verify", 2.5},
          {"writeArcs", 2},
          {"writePatches", 5},
          {"certify", 0.5},
          {"namedPatches", 0.2},
          {"writeHexMesh", 1},
          {"writeLagrangeMesh", 4},
          {"writeViewPage", 10}};
}

Extraction::Extraction(const ExtractArguments& arguments, LongRun& longRun,
                       ExtractionRecord& record)
    : arguments_(arguments), longRun_(longRun), context_(longRun.context()), record_(record) {
  if (!arguments.stream || arguments.parts.parts) return;
  pieces_ = openMeshSink(arguments.output, arguments.choice.options(), context_);
}

void Extraction::run(const TetMap& map) {
  if (arguments_.parts.parts) return inParts(map);
  std::optional<Extractor> extractor = prepare(map);
  if (pieces_ != nullptr) return inPieces(*extractor);
  return arguments_.order > 1 ? curved(map, std::move(extractor))
                              : inMemory(map, std::move(extractor));
}

/// The options; the record receives the repaired map.
ExtractOptions Extraction::options() {
  ExtractOptions options = arguments_.options;
  if (arguments_.repair) options.repair = &record_.repaired;
  return options;
}

/// Creates the extractor, which repairs the map if requested.
Extractor Extraction::prepare(const TetMap& map) {
  const ExtractOptions all = options();
  // If the product overflows, the extraction reports it.
  const bool fits = all.scale <= std::numeric_limits<int>::max() / arguments_.order;
  const int maxScale = fits ? all.scale * arguments_.order : all.scale;
  return longRun_.part(pieces_ != nullptr ? kInPieces : "extraction", [&] {
    return Extractor(map, {all.tolerance, maxScale, all.repair, all.round}, context_);
  });
}

void Extraction::requireVerified(VerifyReport report) {
  record_.verification = std::move(report);
  requirePassed(*record_.verification, "The mesh does not agree with the map and was not written",
                "Please report this with the map.");
}

/// @param extractor  freed as soon as the mesh is verified
void Extraction::inMemory(const TetMap& map, std::optional<Extractor> extractor) {
  PiecewiseLinearMesh all = longRun_.part("extraction", [&]() -> PiecewiseLinearMesh {
    if (arguments_.arcs.empty() && arguments_.patches.empty()) {
      return {extractor->extract(arguments_.options, context_, &record_.statistics), {}, {}};
    }
    const auto parts = arguments_.patches.empty() ? PiecewiseLinearParts::Arcs
                                                  : PiecewiseLinearParts::ArcsAndPatches;
    return extractor->extractPiecewiseLinear(parts, arguments_.options, context_,
                                             &record_.statistics);
  });
  verifyMesh(*extractor, all.mesh);
  extractor.reset();
  writeCurves(map, all);
  finishMesh(map, all.mesh);
  record_.vertices = all.mesh.points.size();
  record_.cells = all.mesh.cells.size();
}

/// The same for cells of higher order.
void Extraction::curved(const TetMap& map, std::optional<Extractor> extractor) {
  LagrangeMesh mesh = longRun_.part("extraction", [&] {
    return extractor->extractLagrange(arguments_.order, arguments_.options, context_,
                                      &record_.statistics);
  });
  record_.straightenedCells = mesh.straightenedCells;
  verifyMesh(*extractor, straightMesh(mesh));
  extractor.reset();
  finishMesh(map, mesh);
  record_.vertices = mesh.vertexCount;
  record_.cells = mesh.cellCount();
  record_.nodes = mesh.points.size();
}

/// The file is complete only if the mesh is right.
void Extraction::inPieces(Extractor& extractor) {
  SummarySink summary(context_, pieces_.get());
  std::optional<VerifySink> proof;
  longRun_.part(kInPieces, [&] {
    if (!arguments_.noVerify) {
      proof.emplace(extractor, VerifyOptions{arguments_.options.scale}, context_, &summary);
    }
    MeshSink& first = proof ? static_cast<MeshSink&>(*proof) : summary;
    extractor.extractTo(first, arguments_.options, context_, &record_.statistics);
  });
  if (proof) requireVerified(proof->report());
  record_.streamed = summary.result();
  record_.vertices = record_.streamed->points;
  record_.cells = record_.streamed->cells;
}

/// Checks that the parts make up one mesh before the files get their names. The processes of a team
/// extract a part each; otherwise this one extracts all.
void Extraction::inParts(const TetMap& map) {
  WriteOptions writing = arguments_.choice.options();
  writing.patchAngle = arguments_.patchAngle.degrees;
  PartOptions parts = arguments_.parts.chosen();
  parts.verify = !arguments_.noVerify;
  ProcessTeam* const team = arguments_.team;
  PartsSummary summary;
  longRun_.part("extraction", [&] {
    const auto files = openPartSink(arguments_.output, writing, context_, team);
    if (team != nullptr) {
      return extractPart(*team, *files, map, options(), parts, context_, &record_.statistics,
                         &summary);
    }
    PartSummarySink checked(*files);
    extractParts(checked, map, options(), parts, context_, &record_.statistics);
    summary = checked.result();
  });
  record_.meshParts = {parts, summary};
  record_.vertices = summary.vertices;
  record_.cells = summary.cells;
}

void Extraction::verifyMesh(Extractor& extractor, const HexMesh& mesh) {
  if (arguments_.noVerify) return;
  requireVerified(longRun_.part("verification", [&] {
    return extractor.verify(mesh, {.scale = arguments_.options.scale}, context_);
  }));
}

/// Writes arcs and patches if requested.
void Extraction::writeCurves(const TetMap& map, const PiecewiseLinearMesh& mesh) {
  const TetMapView used = extractedMap(map, &record_.repaired);
  if (!arguments_.arcs.empty()) {
    longRun_.part("writing", [&] { writeArcs(mesh, used, arguments_.arcs, context_); });
    record_.arcs = {arguments_.arcs, mesh.arcs.count(), mesh.arcs.points.size()};
  }
  if (arguments_.patches.empty()) return;
  longRun_.part("writing", [&] { writePatches(mesh, used, arguments_.patches, context_); });
  record_.patches = {arguments_.patches, mesh.patches.count(), mesh.patches.polygonTet.size()};
}

/// Improves, examines and writes a verified mesh.
void Extraction::finishMesh(const TetMap& map, auto& mesh) {
  const Array<Vec3> before = improveOrCertify(map, mesh);
  WriteOptions writing = arguments_.choice.options();
  writing.scaledJacobians = record_.certificate->scaledJacobians;
  writing.patchAngle = arguments_.patchAngle.degrees;
  longRun_.part("writing",
                [&] { writeNamed(arguments_.names, mesh, arguments_.output, writing, context_); });
  noteBoundary(mesh);
  writeMeshPage(mesh, before);
  record_.tags = {mesh.features.vertices.size(), mesh.features.edges.size(),
                  mesh.features.quads.size()};
}

/// Improves the mesh if requested; otherwise only certifies its quality.
/// @return the points before improvement, if a page shows them; otherwise empty
Array<Vec3> Extraction::improveOrCertify(const TetMap& map, auto& mesh) {
  if (!arguments_.improve) {
    record_.certificate = longRun_.part("quality", [&] { return certify(mesh, context_); });
    return {};
  }
  Array<Vec3> before = arguments_.page.empty() ? Array<Vec3>() : mesh.points;
  record_.improved = longRun_.part("improvement", [&] {
    return improve(mesh, extractedMap(map, &record_.repaired), arguments_.improveOptions, context_);
  });
  record_.certificate = record_.improved->after;
  return pointsBefore(std::move(before), *record_.improved);
}

/// Lists the boundary if the mesh is small or this was requested: it takes 0.7 of 6 s for six
/// million cells.
void Extraction::noteBoundary(const auto& mesh) {
  constexpr std::size_t kFew = 100'000;
  if (record_.certificate->validity.size() > kFew && !arguments_.patchAngle.isGiven) return;
  if (arguments_.run.quiet && arguments_.report.empty()) return;
  record_.boundary = longRun_.part("quality", [&] {
    const double angle = arguments_.patchAngle.degrees;
    if constexpr (std::is_same_v<std::decay_t<decltype(mesh)>, LagrangeMesh>) {
      return namedPatches(straightMesh(mesh), angle, context_);
    } else {
      return namedPatches(mesh, angle, context_);
    }
  });
}

/// @param before  the result of improveOrCertify()
void Extraction::writeMeshPage(const auto& mesh, const Array<Vec3>& before) {
  if (arguments_.page.empty()) return;
  ViewOptions options;
  if (record_.verification) options.verification = &*record_.verification;
  options.mapName = std::filesystem::path(arguments_.input.description()).filename().string();
  options.scaledJacobians = record_.certificate->scaledJacobians;
  options.pointsBefore = before;
  longRun_.part("page",
                [&] { writePage(mesh, arguments_.page, arguments_.output, options, context_); });
}

}  // namespace hexhex::command
