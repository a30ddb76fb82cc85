#include "json.hpp"

#include <string>
#include <utility>
#include <vector>

#include "output.hpp"

namespace hexhex::command {

Json valencesAsJson(const std::map<int, std::uint64_t>& countByValence) {
  Json object = Json::object();
  for (const auto& [valence, count] : countByValence) object[std::to_string(valence)] = count;
  return object;
}

namespace {

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
  Json json = fieldsAsJson(report, {{"valid", report.valid()},
                                    {"kind", kind},
                                    {"integer_factor", factor > 0 ? Json(factor) : Json(nullptr)}});
  json["defects"] = defectsAsJson(report.defects);
  json["scale"] = scale;
  json["expected"] = report.valid() ? fieldsAsJson(report.expected) : Json(nullptr);
  return json;
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

Json checksumsAsJson(const MeshSummary& summary) {
  return {{"cells", checksumAsText(summary.cellChecksum)},
          {"vertices", checksumAsText(summary.pointChecksum)}};
}

Json quantizeAsJson(const QuantizeReport& report) {
  Json json = fieldsAsJson(report);
  json["scaled_jacobian_before"] = distortionAsJson(report.distortionBefore);
  json["scaled_jacobian_after"] = distortionAsJson(report.distortionAfter);
  return json;
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
  return fieldsAsJson(report, {{"before", certificateAsJson(report.before)},
                               {"after", certificateAsJson(report.after)},
                               {"not_positive", report.notPositive},
                               {"distance_before", distance(report.distanceBefore)},
                               {"distance_after", distance(report.distanceAfter)},
                               {"far_cells", report.farCells},
                               {"vertices",
                                {{"free", report.vertices[0]},
                                 {"on_patches", report.vertices[1]},
                                 {"on_curves", report.vertices[2]},
                                 {"fixed", report.vertices[3]},
                                 {"fixed_by_tags", report.taggedVertices},
                                 {"fixed_by_option", report.boundaryVertices},
                                 {"fixed_by_cells", report.pairedVertices}}},
                               {"cannot_be_positive", report.cannotBePositive},
                               {"worst_cell",
                                {{"cell", report.worst.cell},
                                 {"held_by", nameOf(report.worst.holder)},
                                 {"tagged", report.worst.isTagged},
                                 {"vertex", report.worst.vertex},
                                 {"angle", report.worst.angle}}}});
}

Json shapeAsJson(const ShapeReport& report) {
  return fieldsAsJson(
      report, {{"method", nameOf(report.method)},
               {"rotation", report.rotation},
               {"labels", fieldsAsJson(report.labels, {{"valid", report.labels.isValid()}})},
               {"scaled_jacobian", distortionAsJson(report.distortion)}});
}

Json partAsJson(const MeshedPart& part) {
  Json groups = Json::array();
  for (const TagName& group : part.missingGroups) {
    groups.push_back({{"dimension", group.dimension}, {"tag", group.tag}, {"name", group.name}});
  }
  return {{"ways", waysAsJson(part)},
          {"why", part.whyThisWay},
          {"map", shapeAsJson(part.shape)},
          {"quantization", quantizeAsJson(part.quantization)},
          {"verification", verificationAsJson(part.verification)},
          {"improvement", improvementAsJson(part.improvement)},
          {"tags_released", part.tagsReleased},
          {"missing_curves", part.missingCurves},
          {"missing_groups", std::move(groups)}};
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
