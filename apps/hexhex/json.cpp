#include "json.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "output.hpp"

namespace hexhex::command {
namespace {

Json valencesAsJson(const std::map<int, std::uint64_t>& countByValence) {
  Json object = Json::object();
  for (const auto& [valence, count] : countByValence) object[std::to_string(valence)] = count;
  return object;
}

Json expectationAsJson(const Expectation& expected) {
  return {{"cells", expected.cells},
          {"boundary_quads", expected.boundaryQuads},
          {"inner_singular_edges", valencesAsJson(expected.innerSingularEdges)},
          {"boundary_singular_edges", valencesAsJson(expected.boundarySingularEdges)},
          {"euler_characteristic", expected.eulerCharacteristic},
          {"components", expected.components},
          {"boundary_components", expected.boundaryComponents}};
}

Json defectsAsJson(const std::vector<Defect>& defects) {
  Json list = Json::array();
  for (const Defect& defect : defects) {
    Json worst = Json::array();
    for (const Defect::Occurrence& occurrence : defect.worst) {
      worst.push_back({{"place", toString(occurrence.place)}, {"amount", occurrence.amount}});
    }
    list.push_back({{"code", name(defect.code)},
                    {"sentence", defect.sentence},
                    {"count", defect.count},
                    {"worst", std::move(worst)}});
  }
  return list;
}

Json distortionAsJson(const MapDistortion& distortion) {
  return {{"worst", distortion.worst}, {"median", distortion.median}};
}

Json certificateAsJson(const Certificate& certificate) {
  return {{"quality", qualityAsJson(certificate)}, {"validity", validityAsJson(certificate)}};
}

Json waysAsJson(const MeshedPart& part) {
  Json ways = Json::array();
  for (const WayReport& way : part.ways) {
    Json json = {{"method", nameOf(way.method)}};
    if (!way.refusal.empty()) json["refusal"] = way.refusal;
    if (way.hasMesh) {
      json["certified"] = way.isCertified;
      json["minimum"] = way.minimum;
      json["distance"] = way.distance;
      json["curves_followed"] = way.curvesFollowed;
      json["merit"] = way.merit;
    }
    ways.push_back(std::move(json));
  }
  return ways;
}

}  // namespace

std::string nameOf(ShapeMethod method) {
  for (const auto& [name, kind] : kShapeMethods) {
    if (kind == method) return std::string(name);
  }
  return {};
}

Json checkAsJson(const CheckReport& report, int scale,
                 const std::optional<SeamlessReport>& seamless) {
  const double factor = seamless ? seamless->integerFactor : 0;
  const char* kind = seamless ? kindName(*seamless) : "neither";
  if (report.valid()) kind = "integer";
  return {{"valid", report.valid()},
          {"kind", kind},
          {"integer_factor", factor > 0 ? Json(factor) : Json(nullptr)},
          {"points", report.points},
          {"tets", report.tets},
          {"edges", report.edges},
          {"faces", report.faces},
          {"inner_faces", report.innerFaces},
          {"boundary_faces", report.boundaryFaces},
          {"chart_jumps", report.chartJumps},
          {"isolated_vertices", report.isolatedVertices},
          {"tets_inverted_in_space", report.tetsInvertedInSpace},
          {"mirrored", report.mirrored},
          {"corners_reversed", report.cornersReversed},
          {"max_transition_residual", report.maxTransitionResidual},
          {"max_displacement", report.maxDisplacement},
          {"inner_singular_tet_edges", valencesAsJson(report.innerSingularTetEdges)},
          {"boundary_singular_tet_edges", valencesAsJson(report.boundarySingularTetEdges)},
          {"singular_nodes", report.singularNodes},
          {"boundary_genus", report.boundaryGenus},
          {"defects", defectsAsJson(report.defects)},
          {"scale", scale},
          {"expected", report.valid() ? expectationAsJson(report.expected) : Json(nullptr)}};
}

Json qualityAsJson(const Certificate& certificate) {
  const QualitySummary& quality = certificate.quality;
  return {{"minimum", quality.minimum},
          {"mean", quality.mean},
          {"not_positive", quality.notPositive},
          {"histogram", quality.histogram}};
}

Json validityAsJson(const Certificate& certificate) {
  Json worst = Json::array();
  for (const RefutedCell& bad : certificate.worst) {
    worst.push_back({{"cell", bad.cell},
                     {"place", bad.place},
                     {"position", bad.position},
                     {"scaled_jacobian", bad.scaledJacobian}});
  }
  return {{"positive", certificate.positive},
          {"refuted", certificate.refuted},
          {"undecided", certificate.undecided},
          {"minimum", certificate.minimum},
          {"worst", std::move(worst)}};
}

Json boundaryAsJson(std::span<const NamedPatch> patches) {
  Json list = Json::array();
  for (const NamedPatch& patch : patches) {
    list.push_back({{"name", patch.name},
                    {"tag", patch.tag},
                    {"quads", patch.quads.size()},
                    {"area", patch.area},
                    {"centre", patch.centre},
                    {"normal", patch.normal}});
  }
  return list;
}

Json verificationAsJson(const VerifyReport& verification) {
  Json items = Json::array();
  for (const VerifyItem& item : verification.items) {
    items.push_back({{"name", item.name},
                     {"expected", item.expected},
                     {"found", item.found},
                     {"passed", item.passed}});
  }
  return {{"passed", verification.passed()}, {"items", std::move(items)}};
}

Json checksumsAsJson(const MeshSurvey& survey) {
  return {{"cells", checksumAsText(survey.cellChecksum)},
          {"vertices", checksumAsText(survey.pointChecksum)}};
}

Json quantizeAsJson(const QuantizeReport& report) {
  return {{"cells_wanted", report.cellsWanted},
          {"cells", report.cells},
          {"scale", report.scale},
          {"displacement", report.displacement},
          {"blocks", report.blocks},
          {"arcs", report.arcs},
          {"shortest_arc", report.shortestArc},
          {"longest_arc", report.longestArc},
          {"integers_by", report.integersBy},
          {"attempts", report.attempts},
          {"split_edges", report.splitEdges},
          {"added_tets", report.addedTets},
          {"scaled_jacobian_before", distortionAsJson(report.distortionBefore)},
          {"scaled_jacobian_after", distortionAsJson(report.distortionAfter)}};
}

const char* nameOf(CellHolder holder) noexcept {
  switch (holder) {
    case CellHolder::Surface:
      return "surface";
    case CellHolder::Curve:
      return "curve";
    case CellHolder::Corner:
      return "corner";
    case CellHolder::Held:
      return "held vertex";
    case CellHolder::SharedFaces:
      return "shared faces";
    default:
      return "neighbours";
  }
}

Json improvementAsJson(const ImproveReport& report) {
  const auto distance = [](const SurfaceDistance& d) {
    return Json{
        {"from_mesh", d.fromMesh}, {"from_surface", d.fromSurface}, {"hausdorff", d.hausdorff()}};
  };
  return {{"before", certificateAsJson(report.before)},
          {"after", certificateAsJson(report.after)},
          {"not_positive", report.notPositive},
          {"diagonal", report.diagonal},
          {"distance_before", distance(report.distanceBefore)},
          {"distance_after", distance(report.distanceAfter)},
          {"inner_distance_before", report.innerDistanceBefore},
          {"inner_distance_after", report.innerDistanceAfter},
          {"far_cells_before", report.farCellsBefore},
          {"far_cells", report.farCells},
          {"vertices",
           {{"free", report.vertices[0]},
            {"on_patches", report.vertices[1]},
            {"on_curves", report.vertices[2]},
            {"fixed", report.vertices[3]},
            {"fixed_by_tags", report.taggedVertices},
            {"fixed_by_option", report.boundaryVertices},
            {"fixed_by_cells", report.pairedVertices}}},
          {"moved_vertices", report.movedVertices},
          {"largest_move", report.largestMove},
          {"mean_move", report.meanMove},
          {"off_surface", report.offSurface},
          {"off_creases", report.offCreases},
          {"added_cells", report.addedCells},
          {"curve_length", report.curveLength},
          {"curves_followed", report.curvesFollowed},
          {"snapped_curves", report.snappedCurves},
          {"cannot_be_positive", report.cannotBePositive},
          {"worst_cell",
           {{"cell", report.worst.cell},
            {"held_by", nameOf(report.worst.holder)},
            {"tagged", report.worst.isTagged},
            {"vertex", report.worst.vertex},
            {"angle", report.worst.angle}}},
          {"seconds", report.seconds}};
}

Json shapeAsJson(const ShapeReport& report) {
  const LabelReport& labels = report.labels;
  return {{"method", nameOf(report.method)},
          {"rotation", report.rotation},
          {"labels",
           {{"valid", labels.isValid()},
            {"charts", labels.charts},
            {"corners", labels.corners},
            {"bad_loops", labels.badLoops},
            {"bad_corners", labels.badCorners},
            {"opposite_edges", labels.oppositeEdges},
            {"turning_points", labels.turningPoints},
            {"wrong_turns", labels.wrongTurns},
            {"flat_charts", labels.flatCharts},
            {"deviation", labels.deviation}}},
          {"label_moves", report.labelMoves},
          {"added_tets", report.addedTets},
          {"feature_edges", report.featureEdges},
          {"tagged_edges", report.taggedEdges},
          {"inner_faces", report.innerFaces},
          {"aligned_faces", report.alignedFaces},
          {"aligned_area", report.alignedArea},
          {"scaled_jacobian", distortionAsJson(report.distortion)}};
}

Json partAsJson(const MeshedPart& part) {
  return {{"ways", waysAsJson(part)},
          {"why", part.whyThisWay},
          {"map", shapeAsJson(part.shape)},
          {"quantization", quantizeAsJson(part.quantization)},
          {"verification", verificationAsJson(part.verification)},
          {"improvement", improvementAsJson(part.improvement)},
          {"tags_released", part.tagsReleased},
          {"missing_curves", part.missingCurves}};
}

Json secondsAsJson(std::span<const StageTime> stages) {
  Json json = Json::object();
  for (const StageTime& stage : stages) json[stage.stage] = stage.seconds;
  return json;
}

const char* kindName(const SeamlessReport& report) noexcept {
  if (report.integerFactor > 0) return "integer up to a scale";
  switch (report.kind) {
    case SeamlessKind::Seamless:
      return "seamless";
    case SeamlessKind::AlmostSeamless:
      return "almost seamless";
    default:
      return "neither";
  }
}

std::string jsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hexhex::command
