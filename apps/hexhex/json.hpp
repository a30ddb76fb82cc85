// Reports as JSON, for programs. docs/report.md explains the keys.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <hexhex/check.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/survey.hpp>
#include <hexhex/verify.hpp>

namespace hexhex::command {

/// Keys in the order in which they are added: easier to read than alphabetical.
using Json = nlohmann::ordered_json;

/// @param seamless  empty if nobody looked
[[nodiscard]] Json checkAsJson(const CheckReport& report, int scale,
                               const std::optional<SeamlessReport>& seamless);

[[nodiscard]] Json qualityAsJson(const Certificate& certificate);
[[nodiscard]] Json validityAsJson(const Certificate& certificate);
[[nodiscard]] Json verificationAsJson(const VerifyReport& verification);
[[nodiscard]] Json checksumsAsJson(const MeshSurvey& survey);
[[nodiscard]] Json quantizeAsJson(const QuantizeReport& report);

/// What a map is that is no integer-grid map: "integer up to a scale", "seamless", "almost
/// seamless", "neither".
[[nodiscard]] const char* kindName(const SeamlessReport& report) noexcept;

/// Whether a map is worth a look at whether it is seamless, by the defect that was found first.
[[nodiscard]] bool mayBeSeamless(ErrorCode code) noexcept;

/// With a line break at its end. File names need not be valid UTF-8; bytes that are not are
/// replaced.
[[nodiscard]] std::string jsonText(const Json& json);

}  // namespace hexhex::command
