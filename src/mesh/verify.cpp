// What is expected of a mesh follows from check(), which knows nothing of extraction.
#include <algorithm>
#include <string>

#include <hexhex/check.hpp>
#include <hexhex/error.hpp>
#include <hexhex/verify.hpp>

#include <base/parallel.hpp>
#include <mesh/verify_against.hpp>

namespace hexhex {
namespace {

/// "2 defects, first: FlippedTet, tet 7"
std::string describe(const std::vector<Defect>& defects) {
  std::string text = "no: " + std::string(name(defects.front().code));
  if (!defects.front().worst.empty())
    text += " at " + toString(defects.front().worst.front().place);
  const std::size_t more = defects.size() - 1;
  if (more > 0) text += ", and " + std::to_string(more) + " more kinds of defects";
  return text;
}

}  // namespace

VerifyReport verify(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options,
                    Context& context) {
  const CheckReport report = check(map, {options.tolerance, options.scale}, context);
  if (!report.valid()) return {{{"map_valid", "yes", describe(report.defects), false}}};

  // Positions need not be looser than what sanitization really did to the parameters.
  VerifyOptions tightened = options;
  tightened.tolerance = std::min(options.tolerance, report.maxDisplacement);
  VerifyReport result;
  withThreads(context.threads(), [&] {
    Stage stage(context, "verification");
    result = verifyAgainst(report.expected, map, mesh, tightened, stage);
  });
  result.items.insert(result.items.begin(), {"map_valid", "yes", "yes", true});
  return result;
}

VerifyReport verify(const TetMapView& map, const HexMesh& mesh, const VerifyOptions& options) {
  Context context;
  return verify(map, mesh, options, context);
}

}  // namespace hexhex
