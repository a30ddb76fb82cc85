// Reports as JSON, for programs. docs/user/report.md explains the keys.
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

/// Keys in the order in which they are added: easier to read than alphabetical.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json valencesAsJson(const std::map<int, std::uint64_t>& countByValence);

/// An object with the fields of a report, behind those that are given.
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

/// @param seamless  empty if nobody looked
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
/// As the option --method has them.
inline constexpr std::array<NamedMethod, 3> kShapeMethods = {{{"auto", ShapeMethod::Auto},
                                                              {"polycube", ShapeMethod::Polycube},
                                                              {"frames", ShapeMethod::Frames}}};
[[nodiscard]] std::string nameOf(ShapeMethod method);

/// What a map is that is no integer-grid map: "integer up to a scale", "seamless", "almost
/// seamless", "neither".
[[nodiscard]] const char* kindName(const SeamlessReport& report) noexcept;

/// With a line break at its end. File names need not be valid UTF-8; bytes that are not are
/// replaced.
[[nodiscard]] std::string jsonText(const Json& json);

}  // namespace hexhex::command
