// Reports as JSON. docs/user/report.md explains the keys.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/fields.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/mesh.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/shape.hpp>
#include <hexhex/summary.hpp>
#include <hexhex/verify.hpp>

namespace hexhex::command {

/// Keeps keys in order of insertion: easier to read than alphabetical order.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json valencesAsJson(const std::map<int, std::uint64_t>& countByValence);

/// Appends the fields of a report to a JSON object.
template <class Report>
[[nodiscard]] Json fieldsAsJson(const Report& report, Json json = Json::object()) {
  visitFields(report, [&json](const char* field, const auto& value) {
    if constexpr (requires { valencesAsJson(value); }) {
      json[field] = valencesAsJson(value);
    } else {
      json[field] = value;
    }
  });
  return json;
}

/// @param seamless  empty if not examined
[[nodiscard]] Json checkAsJson(const CheckReport& report, int scale,
                               const std::optional<SeamlessReport>& seamless);

[[nodiscard]] Json qualityAsJson(const Certificate& certificate);
[[nodiscard]] Json validityAsJson(const Certificate& certificate);
[[nodiscard]] Json boundaryAsJson(std::span<const NamedPatch> patches);
[[nodiscard]] Json verificationAsJson(const VerifyReport& verification);
[[nodiscard]] Json checksumsAsJson(const MeshSummary& summary);
[[nodiscard]] Json quantizeAsJson(const QuantizeReport& report);
[[nodiscard]] Json improvementAsJson(const ImproveReport& report);
[[nodiscard]] Json shapeAsJson(const ShapeReport& report);
/// {"reading": 0.01, "extraction": 3.85, ...}
[[nodiscard]] Json secondsAsJson(std::span<const StageTime> stages);
/// The reports of a part, without its files and times.
[[nodiscard]] Json partAsJson(const MeshedPart& part);

struct NamedMethod {
  std::string_view name;
  ShapeMethod kind;
};
/// The values of the option --method.
inline constexpr std::array<NamedMethod, 3> kShapeMethods = {{{"auto", ShapeMethod::Auto},
                                                              {"polycube", ShapeMethod::Polycube},
                                                              {"frames", ShapeMethod::Frames}}};
[[nodiscard]] std::string nameOf(ShapeMethod method);

/// The kind of a map that is not an integer-grid map: "integer up to a scale", "seamless", "almost
/// seamless", "neither".
[[nodiscard]] const char* kindName(const SeamlessReport& report) noexcept;

/// Formats JSON with a line break at the end. Invalid UTF-8, as file names may contain, is
/// replaced.
[[nodiscard]] std::string jsonText(const Json& json);

}  // namespace hexhex::command
