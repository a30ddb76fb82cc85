// Advice for maps that are not integer-grid maps, but can be made such.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include <hexhex/quantize.hpp>

namespace hexhex {
namespace quantization {
namespace {

std::string digitsOf(double value, int digits) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

}  // namespace
}  // namespace quantization

bool mayBeSeamless(ErrorCode code) noexcept {
  // A map that is not integer may get flipped tets from rounding to integers.
  return code == ErrorCode::FlippedTet || code == ErrorCode::TransitionResidual ||
         code == ErrorCode::BoundaryOffLattice || code == ErrorCode::SingularityOffLattice ||
         code == ErrorCode::HalfIntegerFixedPoint;
}

std::string adviceFor(const SeamlessReport& report, const QuantizeCall& call) {
  if (report.kind == SeamlessKind::Neither) return {};
  if (report.integerFactor > 0) {
    const std::string factor = quantization::digitsOf(report.integerFactor, 12);
    return "The map is integer up to a scale: multiply its parameters by " + factor + ", as " +
           call("scale", factor) + " does.";
  }
  const std::string cells = std::to_string(std::llround(std::max(report.cells, 1000.0)));
  const std::string displacement = quantization::digitsOf(report.displacement, 3);
  if (report.kind == SeamlessKind::Seamless) {
    return "The map is seamless (to within " + displacement +
           "), but not integer. Make it an integer-grid map: " + call("cells", cells) + ".";
  }
  return "The map is almost seamless: the nearest map that is differs by up to " + displacement +
         ". Let the map's solver converge further, or write more digits; or take that one, with a "
         "larger tolerance: " +
         call("cells", cells) + ".";
}

Error withAdvice(const Error& error, const TetMapView& map, const QuantizeCall& call,
                 Context& context) {
  if (!canQuantize() || !mayBeSeamless(error.code())) return error;
  const SeamlessReport report = examineSeamless(map, context);
  const std::string advice = adviceFor(report, call);
  if (!advice.empty()) return {error.code(), advice};
  return {error.code(), std::string(error.what()) + " Nor can it be quantized: " + report.problem,
          error.place()};
}

}  // namespace hexhex
