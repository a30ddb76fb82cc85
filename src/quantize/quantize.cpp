// Quantization of a seamless map: traces its motorcycle complex, finds integers for the arcs, and
// bends the map onto these (Brückler et al. 2022, Volume Parametrization Quantization for
// Hexahedral Meshing).
#include <string>

#include <hexhex/quantize.hpp>

#if defined(HEXHEX_HAS_QUANTIZE)
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <quantize/complex/wall_mesh.hpp>
#include <quantize/quantized_map.hpp>
#include <quantize/seamless/integer_factor.hpp>
#include <quantize/sorted_tets.hpp>
#else
#include <base/missing_library.hpp>
#endif

#if defined(HEXHEX_HAS_QUANTIZE)
namespace hexhex::quantization {
namespace {

/// Maximum deviation of an almost seamless map from the nearest seamless one, relative to the map's
/// size.
constexpr double kAlmost = 0.01;
/// Where walls leave no room for tets between them, planes up to this distance apart, relative to
/// the map's size, are merged; values are tried in turn. Cells are rarely smaller than the last.
constexpr std::array<double, 6> kApart = {0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};

void checkOptions(const QuantizeOptions& options) {
  int given = 0;
  for (const double each : {options.cells, options.scale, options.edgeLength}) {
    if (!(each >= 0) || !std::isfinite(each)) {
      throw Error(ErrorCode::InvalidArgument,
                  "The number of cells, the scale and the edge length of a quantized map are "
                  "positive numbers.");
    }
    given += each > 0 ? 1 : 0;
  }
  if (given != 1) {
    throw Error(ErrorCode::InvalidArgument,
                "Say how fine the mesh is to be: by a number of cells, a scale, or an edge length, "
                "one of them and greater than 0.");
  }
  if (!(options.tolerance >= 0 && options.tolerance <= 0.01)) {
    throw Error(ErrorCode::InvalidArgument,
                "The tolerance of quantization is a share of the map's size, from 0 to 0.01.");
  }
}

/// Whether vertices of tets exist and there are as many regions as tets, if any.
bool areInRange(const TetMapView& map) {
  if (!map.regions.empty() && map.regions.size() != map.tets.size()) return false;
  return std::all_of(map.tets.begin(), map.tets.end(), [&map](const Tet& tet) {
    return std::all_of(tet.begin(), tet.end(), [&map](Index v) { return v < map.points.size(); });
  });
}

/// Merges planes at increasing distances until the tets between walls are thick enough.
/// @param[out] order  the caller's number of each tet while sorted
QuantizedMap quantizeSorted(const TetMapView& given, const QuantizeOptions& options,
                            std::vector<Index>& order, Context& context) {
  std::optional<Error> tooThin;
  for (const double apart : kApart) {
    TetMap map = inCanonicalOrder(given, order);
    try {
      SeamlessMap seamless = makeSeamless(
          map, {options.tolerance, options.tolerance, options.wallTag, apart}, context);
      requirePositiveTets(seamless);
      std::vector<TetParameters>().swap(map.parameters);  // frees memory
      return finishQuantization(findBentMap(std::move(seamless), map, options, context), map,
                                context);
    } catch (const TooThinForWalls& error) {
      if (!tooThin) tooThin = error;
    } catch (const Error& error) {
      // Merging planes can flip tets; the first error is more helpful then.
      if (!tooThin || error.code() != ErrorCode::FlippedTet) throw;
    }
  }
  throw Error(*tooThin);
}

}  // namespace
}  // namespace hexhex::quantization
#endif

namespace hexhex {

#if defined(HEXHEX_HAS_QUANTIZE)

bool canQuantize() noexcept { return true; }

SeamlessReport examineSeamless(const TetMapView& map, Context& context) {
  constexpr std::array<WorkStep, 2> kSteps = {{{"seamless map", 4}, {"prepare", 1}}};
  WorkSteps steps(context, "examineSeamless", kSteps);
  SeamlessReport report;
  try {
    const quantization::SeamlessMap seamless =
        quantization::makeSeamless(map, {quantization::kAlmost, 0, 0}, context);
    report.displacement = seamless.maxDisplacement;
    report.cells = quantization::volumeOf(seamless);
    report.kind = report.displacement <= QuantizeOptions{}.tolerance * seamless.size
                      ? SeamlessKind::Seamless
                      : SeamlessKind::AlmostSeamless;
    if (report.kind == SeamlessKind::Seamless || !seamless.flippedAsGiven.empty()) {
      quantization::requirePositiveTets(seamless);
    }
    report.integerFactor = quantization::integerFactor(map, seamless, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    report.kind = SeamlessKind::Neither;
    report.problem = error.what();
    const std::string where = toString(error.place());
    if (!where.empty()) report.problem += " [" + where + "]";
  }
  steps.finish();
  return report;
}

QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options, Context& context) {
  constexpr std::array<WorkStep, 5> kSteps = {{{"seamless map", 1},
                                               {"motorcycle complex", 2},
                                               {"integers", 2},
                                               {"bending", 4},
                                               {"singular curves", 0.2}}};
  quantization::checkOptions(options);
  WorkSteps steps(context, "quantize", kSteps);
  QuantizedMap result;
  withThreads(context.threads(), [&] {
    // Invalid arrays cannot be sorted; makeSeamless() reports what is wrong with them.
    if (map.parameters.size() != map.tets.size() || !quantization::areInRange(map)) {
      static_cast<void>(quantization::makeSeamless(map, {}, context));
    }
    std::vector<Index> order;
    try {
      result = quantization::quantizeSorted(map, options, order, context);
    } catch (const Error& error) {
      throw quantization::inCallersTerms(error, map, order);
    }
    quantization::restoreOrder(order, result.map);
  });
  steps.finish();
  return result;
}
#else
bool canQuantize() noexcept { return false; }

SeamlessReport examineSeamless(const TetMapView& /*map*/, Context& /*context*/) { return {}; }

QuantizedMap quantize(const TetMapView& /*map*/, const QuantizeOptions& /*options*/,
                      Context& /*context*/) {
  failWithoutLibrary("quantize maps", "Eigen (libeigen3-dev)");
}
#endif

QuantizedMap quantize(const TetMapView& map, const QuantizeOptions& options) {
  Context context;
  return quantize(map, options, context);
}

}  // namespace hexhex
