// What JavaScript calls: one function, which takes a request as JSON and answers with JSON. Arrays
// stay where they are: answers hold their addresses, and JavaScript looks at the memory
// (src/index.ts). Files are those of emscripten's file system in memory. The keys of reports are
// the command's.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <emscripten.h>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <json.hpp>
#include <nlohmann/json.hpp>

#include <hexhex/hexhex.hpp>
#include <hexhex/view.hpp>

namespace {

using namespace hexhex;
using command::Json;

// NOLINTNEXTLINE(*): JavaScript
EM_JS(void, reportProgress, (const char* stage, double share), {
  if (Module.onProgress) Module.onProgress(UTF8ToString(stage), share);
});

/// A mesh, and what is only computed once.
struct Mesh {
  HexMesh mesh;
  std::optional<Certificate> certificate = {};
  std::optional<VerifyReport> verification = {};
};
using Object = std::variant<TetMap, Mesh>;

std::map<std::uint32_t, Object>& objects() {
  static std::map<std::uint32_t, Object> all;
  return all;
}

std::uint32_t keep(Object object) {
  static std::uint32_t last = 0;
  objects().emplace(++last, std::move(object));
  return last;
}

/// What a number stands for. @throws Error InvalidArgument for what was freed, or is something else
template <class T>
T& get(const Json& request, const char* key) {
  const auto found = objects().find(request.at(key).get<std::uint32_t>());
  T* const object = found == objects().end() ? nullptr : std::get_if<T>(&found->second);
  if (object == nullptr) {
    throw Error(ErrorCode::InvalidArgument,
                std::string("The ") + key + " has been freed, or is none. Give one that lives.");
  }
  return *object;
}

/// Json converts any number to integers, without a word: fractions, and what has more bits.
/// @throws Error InvalidArgument for a number that T does not hold
template <class T>
void requireWhole(const Json& number, const char* key) {
  const auto value = number.get<double>();
  const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
  const bool holds =
      value == std::floor(value) && value >= (std::is_signed_v<T> ? -end : 0) && value < end;
  if (holds) return;
  throw Error(ErrorCode::InvalidArgument, "The option " + std::string(key) + " is " +
                                              number.dump() + ". Give an integer that it can be.");
}

/// Sets what the request has, and leaves the default otherwise.
template <class T>
void take(const Json& options, const char* key, T& value) {
  const auto found = options.find(key);
  if (found == options.end()) return;
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) requireWhole<T>(*found, key);
  found->get_to(value);
}

/// The same by the name of what the request has. @throws Error InvalidArgument
template <class Entries, class Kind>
void takeNamed(const Json& options, const char* key, const Entries& entries, Kind& kind) {
  const auto found = options.find(key);
  if (found == options.end()) return;
  const auto name = found->get<std::string>();
  std::string names;
  for (const auto& entry : entries) {
    if (entry.name == name) {
      kind = entry.kind;
      return;
    }
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw Error(ErrorCode::InvalidArgument, "There is no " + std::string(key) + " \"" + name +
                                              "\". Choose one of " + names + ".");
}

Json arrayAt(const void* data, std::size_t length, const char* type) {
  return {{"at", reinterpret_cast<std::uintptr_t>(data)}, {"length", length}, {"type", type}};
}

Json placeAsJson(const Place& place) {
  constexpr std::array<const char*, 7> kKinds = {"none",   "tet",  "face", "edge",
                                                 "vertex", "line", "cell"};
  return {{"text", toString(place)},
          {"kind", kKinds.at(static_cast<std::size_t>(place.kind))},
          {"index", place.index},
          {"second", place.second}};
}

Json mapAnswer(TetMap map) {
  const std::uint32_t id = keep(std::move(map));
  const TetMap& kept = std::get<TetMap>(objects().at(id));
  return {{"map", id}, {"points", kept.points.size()}, {"tets", kept.tets.size()}};
}

Json meshAnswer(Mesh mesh) {
  const std::uint32_t id = keep(std::move(mesh));
  const HexMesh& kept = std::get<Mesh>(objects().at(id)).mesh;
  return {{"mesh", id}, {"vertices", kept.points.size()}, {"cells", kept.cells.size()}};
}

ReadOptions readOptions(const Json& request) {
  ReadOptions options;
  const auto text = [&request](const char* key, std::string_view& value) {
    if (const auto found = request.find(key); found != request.end()) {
      value = found->get_ref<const std::string&>();
    }
  };
  text("format", options.format);
  text("mapArray", options.mapArray);
  take(request, "keepWalls", options.keepWalls);
  take(request, "hexesOnly", options.hexesOnly);
  return options;
}

Json about(const Json& /*request*/, Context& /*context*/) {
  Json formats = Json::array();
  for (const FileFormat& format : fileFormats()) {
    formats.push_back({{"name", format.name},
                       {"extension", format.extension},
                       {"description", format.description},
                       {"readsMaps", format.readsMaps},
                       {"writesMaps", format.writesMaps},
                       {"readsTets", format.readsTets},
                       {"readsHexMeshes", format.readsHexMeshes},
                       {"writesHexMeshes", format.writesHexMeshes}});
  }
  Json samples = Json::array();
  for (const SampleKindName& sample : sampleKinds()) {
    samples.push_back({{"name", sample.name}, {"description", sample.description}});
  }
  return {{"version", HEXHEX_VERSION},
          {"formats", std::move(formats)},
          {"samples", std::move(samples)},
          {"canQuantize", canQuantize()}};
}

Json generate(const Json& request, Context& /*context*/) {
  SampleOptions options;
  take(request, "cells", options.cells);
  take(request, "refine", options.refine);
  take(request, "valence", options.valence);
  take(request, "jitter", options.jitter);
  take(request, "onLattice", options.onLattice);
  take(request, "noise", options.noise);
  take(request, "offset", options.offset);
  take(request, "stretch", options.stretch);
  take(request, "features", options.features);
  take(request, "seed", options.seed);
  take(request, "defects", options.defects);
  takeNamed(request, "charts", chartStyles(), options.charts);
  takeNamed(request, "defectKind", defectKinds(), options.defectKind);
  SampleKind kind{};
  takeNamed(request, "kind", sampleKinds(), kind);
  return mapAnswer(generateSample(kind, options).map);
}

/// A map whose arrays JavaScript fills: room for so many points and tets, and parameters or none.
Json makeMap(const Json& request, Context& /*context*/) {
  TetMap map;
  map.points.resize(request.at("points"));
  map.tets.resize(request.at("tets"));
  if (request.at("parameters").get<bool>()) map.parameters.resize(map.tets.size());
  return mapAnswer(std::move(map));
}

Json readMap(const Json& request, Context& context) {
  return mapAnswer(
      hexhex::readMap(request.at("file").get<std::string>(), readOptions(request), context));
}

/// Without parameters.
Json readTets(const Json& request, Context& context) {
  TetMesh tets = readTetMesh(request.at("file").get<std::string>(), readOptions(request), context);
  TetMap map;
  map.points = std::move(tets.points);
  map.tets = std::move(tets.tets);
  return mapAnswer(std::move(map));
}

Json readMesh(const Json& request, Context& context) {
  return meshAnswer(
      {readHexMesh(request.at("file").get<std::string>(), readOptions(request), context)});
}

Json read(const Json& request, Context& context) {
  auto content =
      readMapOrHexMesh(request.at("file").get<std::string>(), readOptions(request), context);
  if (auto* const map = std::get_if<TetMap>(&content)) return mapAnswer(std::move(*map));
  return meshAnswer({std::move(std::get<HexMesh>(content))});
}

Json mapArrays(const Json& request, Context& /*context*/) {
  TetMap& map = get<TetMap>(request, "map");
  return {{"points", arrayAt(map.points.data(), 3 * map.points.size(), "f64")},
          {"tets", arrayAt(map.tets.data(), 4 * map.tets.size(), "u32")},
          {"parameters", arrayAt(map.parameters.data(), 12 * map.parameters.size(), "f64")},
          {"regions", arrayAt(map.regions.data(), map.regions.size(), "i32")}};
}

Json meshArrays(const Json& request, Context& /*context*/) {
  const auto& [mesh, certificate, verification] = get<Mesh>(request, "mesh");
  Json arrays = {
      {"points", arrayAt(mesh.points.data(), 3 * mesh.points.size(), "f64")},
      {"cells", arrayAt(mesh.cells.data(), 8 * mesh.cells.size(), "u32")},
      {"generatorTet", arrayAt(mesh.generatorTet.data(), mesh.generatorTet.size(), "u32")},
      {"generatorCorners",
       arrayAt(mesh.generatorCorners.data(), mesh.generatorCorners.size(), "u8")},
      {"regions", arrayAt(mesh.regions.data(), mesh.regions.size(), "i32")}};
  if (certificate) {
    const auto& jacobians = certificate->scaledJacobians;
    arrays["scaledJacobians"] = arrayAt(jacobians.data(), jacobians.size(), "f64");
    arrays["validity"] = arrayAt(certificate->validity.data(), certificate->validity.size(), "u8");
  }
  return arrays;
}

Json checkMap(const Json& request, Context& context) {
  const TetMap& map = get<TetMap>(request, "map");
  CheckOptions options;
  take(request, "scale", options.scale);
  take(request, "tolerance", options.tolerance);
  const CheckReport report = check(map, options, context);
  std::optional<SeamlessReport> seamless;
  if (!report.valid() && canQuantize() && mayBeSeamless(report.defects.front().code)) {
    seamless = examineSeamless(map, context);
  }
  Json json = command::checkAsJson(report, options.scale, seamless);
  // Where exactly, as pages draw it.
  for (std::size_t i = 0; i < report.defects.size(); ++i) {
    Json& worst = json["defects"][i]["worst"];
    for (std::size_t k = 0; k < worst.size(); ++k) {
      worst[k]["place"] = placeAsJson(report.defects[i].worst[k].place);
    }
  }
  return json;
}

Json quantizeMap(const Json& request, Context& context) {
  const TetMap& map = get<TetMap>(request, "map");
  QuantizeOptions options;
  take(request, "cells", options.cells);
  take(request, "scale", options.scale);
  take(request, "edgeLength", options.edgeLength);
  take(request, "densify", options.densify);
  take(request, "wallTag", options.wallTag);
  take(request, "tolerance", options.tolerance);
  QuantizedMap result = quantize(map, options, context);
  Json answer = mapAnswer(std::move(result.map));
  answer["report"] = command::quantizeAsJson(result.report);
  return answer;
}

struct NamedPillow {
  std::string_view name;
  PillowMode kind;
};
constexpr std::array<NamedPillow, 3> kPillows = {
    {{"never", PillowMode::Never}, {"auto", PillowMode::Auto}, {"always", PillowMode::Always}}};

/// Of tets, a mesh and its map.
Json meshTets(const Json& request, Context& context) {
  const TetMap& tets = get<TetMap>(request, "tets");
  MeshOptions options;
  options.quantize.densify = true;
  take(request, "cells", options.quantize.cells);
  take(request, "edgeLength", options.quantize.edgeLength);
  takeNamed(request, "method", command::kShapeMethods, options.shape.method);
  take(request, "seed", options.shape.seed);
  take(request, "target", options.improve.target);
  take(request, "passes", options.improve.passes);
  take(request, "fixBoundary", options.improve.fixBoundary);
  take(request, "featureAngle", options.improve.featureAngle);
  options.shape.featureAngle = options.improve.featureAngle;
  take(request, "slack", options.improve.slack);
  takeNamed(request, "pillow", kPillows, options.improve.pillow);
  MeshedPart part = meshFromTets({tets.points, tets.tets}, options, context);
  Json report = command::partAsJson(part);
  Json answer = meshAnswer(
      {std::move(part.mesh), std::move(part.improvement.after), std::move(part.verification)});
  answer.update(mapAnswer(std::move(part.map)));
  answer["report"] = std::move(report);
  return answer;
}

Json extractMesh(const Json& request, Context& context) {
  const TetMap& map = get<TetMap>(request, "map");
  ExtractOptions options;
  take(request, "scale", options.scale);
  take(request, "tolerance", options.tolerance);
  ExtractStatistics statistics;
  Json answer = meshAnswer({extract(map, options, context, &statistics)});
  answer["seconds"] = statistics.seconds;
  return answer;
}

Json verifyMesh(const Json& request, Context& context) {
  auto& mesh = get<Mesh>(request, "mesh");
  VerifyOptions options;
  take(request, "scale", options.scale);
  take(request, "tolerance", options.tolerance);
  mesh.verification = verify(get<TetMap>(request, "map"), mesh.mesh, options, context);
  return command::verificationAsJson(*mesh.verification);
}

const Certificate& certificateOf(Mesh& mesh, Context& context) {
  if (!mesh.certificate) mesh.certificate = certify(mesh.mesh, context);
  return *mesh.certificate;
}

Json certifyMesh(const Json& request, Context& context) {
  const Certificate& certificate = certificateOf(get<Mesh>(request, "mesh"), context);
  return {{"quality", command::qualityAsJson(certificate)},
          {"validity", command::validityAsJson(certificate)}};
}

Json write(const Json& request, Context& context) {
  WriteOptions options;
  options.format = readOptions(request).format;
  take(request, "patchAngle", options.patchAngle);
  bool compress = false;
  take(request, "compress", compress);
  if (compress) options.compress = Compression::Zlib;
  const auto file = request.at("file").get<std::string>();
  if (request.contains("map")) {
    writeMap(get<TetMap>(request, "map"), file, options, context);
    return {};
  }
  Mesh& mesh = get<Mesh>(request, "mesh");
  if (mesh.certificate) options.scaledJacobians = mesh.certificate->scaledJacobians;
  writeHexMesh(mesh.mesh, file, options, context);
  return {};
}

#if HEXHEX_HAS_VIEWER
Json writePage(const Json& request, Context& context) {
  Mesh& mesh = get<Mesh>(request, "mesh");
  ViewOptions options;
  take(request, "title", options.title);
  take(request, "mapName", options.mapName);
  if (mesh.verification) options.verification = &*mesh.verification;
  options.scaledJacobians = certificateOf(mesh, context).scaledJacobians;
  writeViewPage(mesh.mesh, request.at("file").get<std::string>(), options, context);
  return {};
}
#endif

Json freeObject(const Json& request, Context& /*context*/) {
  objects().erase(request.at("id").get<std::uint32_t>());
  return {};
}

using Function = Json (*)(const Json& request, Context& context);
constexpr std::array kFunctions = std::to_array<std::pair<std::string_view, Function>>({
  {"about", about}, {"generate", generate}, {"makeMap", makeMap}, {"readMap", readMap},
      {"readTets", readTets}, {"mesh", meshTets}, {"readMesh", readMesh}, {"read", read},
      {"mapArrays", mapArrays}, {"meshArrays", meshArrays}, {"check", checkMap},
      {"quantize", quantizeMap}, {"extract", extractMesh}, {"verify", verifyMesh},
      {"certify", certifyMesh}, {"write", write},
#if HEXHEX_HAS_VIEWER
      {"writePage", writePage},
#endif
      {"free", freeObject},
});

Json failure(ErrorCode code, std::string_view message, const Place& place = {}) {
  return {{"error", {{"code", name(code)}, {"message", message}, {"place", placeAsJson(place)}}}};
}

constexpr std::string_view kNoMemory =
    "Memory is exhausted: pages and Node have 4 GB for a mesh. Use a smaller scale, or the "
    "command.";

Json answerTo(const char* text) {
  try {
    const Json request = Json::parse(text);
    const auto wanted = request.at("call").get<std::string>();
    const auto* const found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                           [&](const auto& each) { return each.first == wanted; });
    if (found == kFunctions.end()) {
      return failure(ErrorCode::InvalidArgument, "There is no function " + wanted + ".");
    }
    Context context(1, [](std::string_view stage, double share) {
      reportProgress(std::string(stage).c_str(), share);
    });
    return {{"result", found->second(request, context)}};
  } catch (const Error& error) {
    return failure(error.code(), error.what(), error.place());
  } catch (const nlohmann::json::exception& error) {
    return failure(ErrorCode::InvalidArgument,
                   std::string("An option is not as expected: ") + error.what());
  } catch (const std::bad_alloc&) {
    return failure(ErrorCode::OutOfMemory, kNoMemory);
  } catch (const std::length_error&) {
    return failure(ErrorCode::OutOfMemory, kNoMemory);
  } catch (const std::exception& error) {
    return failure(ErrorCode::Internal, error.what());
  }
}

}  // namespace

/// @return the answer, which lives until the next call
extern "C" EMSCRIPTEN_KEEPALIVE const char* hexhex_call(const char* request) {
  static std::string answer;
  answer = answerTo(request).dump(-1, ' ', false, Json::error_handler_t::replace);
  return answer.c_str();
}
