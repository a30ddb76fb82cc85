#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <quantize/seamless/integer_factor.hpp>

#include <hexhex/extract.hpp>

#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <igm/igm.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex::quantization {
namespace {

/// The coordinate of a face along the axis perpendicular to it.
double planeOf(const TetParameters& corners, adjacency::HalfFace face) {
  double least = INFINITY;
  double plane = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double lower = INFINITY;
    double upper = -INFINITY;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == face % 4) continue;
      lower = std::min(lower, corners[i][axis]);
      upper = std::max(upper, corners[i][axis]);
    }
    if (upper - lower >= least) continue;
    least = upper - lower;
    plane = (lower + upper) / 2;
  }
  return plane;
}

/// Magnitudes of all numbers that must be integers. In the given charts, as the origin of the
/// seamless map is arbitrary.
std::vector<double> conditions(const adjacency::TetTopology& topology,
                               std::span<const TetParameters> parameters) {
  std::vector<double> sizes;
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (topology.isBoundary(h)) {
      sizes.push_back(std::abs(planeOf(parameters[adjacency::tetOf(h)], h)));
      continue;
    }
    if (topology.mate[h] < h) continue;
    const igm::SharedTriangle triangle(topology, parameters, h);
    const Vec3 translation =
        minus(triangle.there[0], igm::bestRotation(triangle)(triangle.here[0]));
    for (const double x : translation) sizes.push_back(std::abs(x));
  }
  sortUnique(sizes);
  return sizes;
}

/// The largest length of which all sizes are multiples, up to noise; 0 if there is none.
double commonLength(const std::vector<double>& sizes, double noise) {
  // If the noise exceeds this fraction of the length, any size fits.
  constexpr double kNoisesPerLength = 1000;
  double length = 0;
  for (double size : sizes) {
    while (size > noise) {
      if (length == 0) length = size;
      if (length > size) std::swap(length, size);
      size = std::abs(size - std::round(size / length) * length);
    }
    if (length > 0 && length < kNoisesPerLength * noise) return 0;
  }
  // The largest size has the smallest relative error.
  return length == 0 ? 0 : sizes.back() / std::round(sizes.back() / length);
}

/// Rounds to six digits if that changes little: undoes the effect of rounded parameters on a
/// divisor that a person chose.
double withFewDigits(double number) {
  const double unit = std::pow(10.0, std::floor(std::log10(number)) - 5);
  const double shorter = unit < 1 ? std::round(number / unit) / std::round(1 / unit)
                                  : std::round(number / unit) * unit;
  return std::abs(number - shorter) < 1e-9 * number ? shorter : number;
}

bool isInteger(const TetMapView& map, double factor, Context& context) {
  std::vector<TetParameters> scaled(map.parameters.begin(), map.parameters.end());
  for (TetParameters& tet : scaled) {
    for (Vec3& corner : tet) {
      for (double& x : corner) x *= factor;
    }
  }
  TetMapView view = map;
  view.parameters = scaled;
  igm::DefectCollector defects;
  static_cast<void>(igm::prepareMap(view, ExtractOptions{}.tolerance, 1, context, defects,
                                    igm::ChartChoice::Unfolded));
  return defects.empty();
}

}  // namespace

double integerFactor(const TetMapView& map, const SeamlessMap& seamless, Context& context) {
  Stage stage(context, "seamless map");
  igm::DefectCollector defects;
  const igm::OrientedMap input = igm::readInput(map, stage, defects);
  const std::vector<double> sizes = conditions(seamless.topology, input.view.parameters);
  stage.finish();
  if (sizes.empty()) return 0;
  // Twice the displacement that made the map seamless, plus the rounding error of sums.
  const double noise = 2 * seamless.maxDisplacement + 1e-12 * sizes.back();
  const double length = commonLength(sizes, noise);
  if (length == 0) return 0;
  // Around singular edges, fixed points are halves of translations, and must be integers as well.
  for (const double multiple : {1.0, 2.0}) {
    const double factor = withFewDigits(multiple / length);
    if (isInteger(map, factor, context)) return factor;
  }
  return 0;
}

}  // namespace hexhex::quantization
