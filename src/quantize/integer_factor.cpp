#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <quantize/integer_factor.hpp>

#include <hexhex/extract.hpp>

#include <igm/prepare.hpp>

namespace hexhex {
namespace {

/// The coordinate of the face opposite a vertex along the axis that it is perpendicular to.
double planeOf(const Tet& tet, const TetParameters& corners, Index opposite) {
  double least = INFINITY;
  double plane = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double lower = INFINITY;
    double upper = -INFINITY;
    for (std::size_t i = 0; i < 4; ++i) {
      if (tet[i] == opposite) continue;
      lower = std::min(lower, corners[i][axis]);
      upper = std::max(upper, corners[i][axis]);
    }
    if (upper - lower >= least) continue;
    least = upper - lower;
    plane = (lower + upper) / 2;
  }
  return plane;
}

/// Sizes of all that has to be an integer.
std::vector<double> conditions(const TetMapView& map, const SeamlessMap& seamless) {
  std::vector<double> sizes;
  const std::size_t tets = map.tets.size();
  for (Index t = 0; t < tets; ++t) {
    for (int opposite = 0; opposite < 4; ++opposite) {
      const HalfFace h = halfFaceOf(t, opposite);
      if (seamless.topology.isBoundary(h)) {
        // By its vertex: the topology may list corners in another order than the caller.
        const Index vertex = seamless.topology.tets[t][static_cast<std::size_t>(opposite)];
        sizes.push_back(std::abs(planeOf(map.tets[t], map.parameters[t], vertex)));
        continue;
      }
      for (const std::int64_t x : seamless.changes[h].translation) {
        sizes.push_back(std::abs(static_cast<double>(x)) / seamless.unit);
      }
    }
  }
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  return sizes;
}

/// The largest length of which all are multiples but for some noise; 0 if there is none.
double commonLength(const std::vector<double>& sizes, double noise) {
  // A length with less than that many noises would fit anything.
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
  // The largest multiple has the smallest relative error.
  return length == 0 ? 0 : sizes.back() / std::round(sizes.back() / length);
}

/// What a person has divided by, where roundings of the parameters hide it: a number with six
/// digits.
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
  DefectCollector defects;
  static_cast<void>(
      prepareMap(view, ExtractOptions{}.tolerance, 1, context, defects, ChartChoice::Unfolded));
  return defects.empty();
}

}  // namespace

double integerFactor(const TetMapView& map, const SeamlessMap& seamless, Context& context) {
  const std::vector<double> sizes = conditions(map, seamless);
  if (sizes.empty()) return 0;
  // Twice what made it seamless, and what is lost in sums of doubles.
  const double noise = 2 * seamless.maxDisplacement + 1e-12 * sizes.back();
  const double length = commonLength(sizes, noise);
  if (length == 0) return 0;
  // Around singular edges, halves of translations have to be integers as well.
  for (const double multiple : {1.0, 2.0}) {
    const double factor = withFewDigits(multiple / length);
    if (isInteger(map, factor, context)) return factor;
  }
  return 0;
}

}  // namespace hexhex
