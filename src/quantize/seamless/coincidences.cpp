#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <quantize/seamless/coincidences.hpp>

namespace hexhex::quantization {

namespace {

/// Maximum number of planes to compare: with more, some are close by chance.
constexpr std::size_t kMostPlanes = 10'000;
/// Maximum number of transfers of planes across pieces of the cut; for maps that need more, the
/// rest of quantization takes longer than that.
constexpr std::size_t kMostIntersections = 200'000;

/// Planes without a fixed coordinate are represented by one plane per axis, at these fractions of
/// the extent, where other planes are unlikely.
constexpr std::array<double, 3> kAnywhere = {0.1234567, 0.2345671, 0.3456712};

/// A coordinate fixed by conditions, times two.
struct FixedCoordinate {
  std::size_t axis = 0;
  IntegerForm form;

  [[nodiscard]] auto operator<=>(const FixedCoordinate&) const = default;
};

/// Collects all fixed coordinates of a vertex, in the charts of its sectors.
void collectFixed(const VertexConditions& conditions, std::set<FixedCoordinate>& all) {
  for (const VertexConditions::Sector& sector : conditions.sectors) {
    for (int from = 0; from < 3; ++from) {
      const auto& [factor, rest] = conditions.fixed[static_cast<std::size_t>(from)];
      if (factor == 0 || 2 % factor != 0) continue;
      const lattice::Direction to = sector.rotation(lattice::direction(from, 1));
      FixedCoordinate fixed;
      fixed.axis = static_cast<std::size_t>(lattice::axisOf(to));
      fixed.form.add(rest, -lattice::signOf(to) * 2 / factor);
      fixed.form.add(sector.translation[fixed.axis], 2);
      all.insert(std::move(fixed));
    }
  }
}

/// Distinct planes. Adding one that nearly coincides with an existing one yields an equation
/// instead.
class Planes {
 public:
  /// @param values  values of the shared unknowns
  Planes(std::span<const std::int64_t> values, double noise, double extent)
      : sharedCount_(values.size()),
        values_(values.begin(), values.end()),
        near_(static_cast<std::int64_t>(2 * noise)) {
    for (const double share : kAnywhere) values_.push_back(std::llround(share * extent));
  }

  void addAnywhere() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      add({axis, {static_cast<Index>(sharedCount_ + axis), 2}});
    }
  }

  void add(const FixedCoordinate& plane) {
    const std::int64_t value = valueOf(plane);
    const auto at = numbers_.lower_bound({plane.axis, value - near_});
    if (at == numbers_.end() || at->first.first != plane.axis || at->first.second > value + near_) {
      numbers_.emplace(std::pair(plane.axis, value), planes_.size());
      planes_.push_back(plane);
      return;
    }
    const IntegerForm& other = planes_[at->second].form;
    if (other == plane.form) return;
    IntegerForm difference = plane.form;
    difference.add(other, -1);
    // Coincidences with planes of arbitrary coordinates are accidental.
    const auto& terms = difference.terms();
    if (terms.back().first >= sharedCount_) return;
    isAny_ = isAny_ || at->first.second != value;
    if (seen_.insert(difference).second) equations_.push_back(std::move(difference));
  }

  [[nodiscard]] std::size_t size() const noexcept { return planes_.size(); }
  [[nodiscard]] const FixedCoordinate& operator[](std::size_t i) const { return planes_[i]; }
  [[nodiscard]] std::int64_t valueOf(const FixedCoordinate& plane) const {
    return plane.form(values_);
  }
  /// Empty if planes that nearly coincide do so exactly: no equations are needed then.
  [[nodiscard]] std::vector<IntegerForm> equations() && {
    if (!isAny_) equations_.clear();
    return std::move(equations_);
  }

 private:
  std::size_t sharedCount_;
  std::vector<std::int64_t> values_;  ///< of shared unknowns, then of arbitrary planes
  std::int64_t near_;
  std::vector<FixedCoordinate> planes_;
  std::map<std::pair<std::size_t, std::int64_t>, std::size_t> numbers_;  ///< by axis and value
  std::vector<IntegerForm> equations_;                                   ///< without duplicates
  std::set<IntegerForm> seen_;
  bool isAny_ = false;
};

/// Carries planes across pieces of the cut, repeatedly, as walls may wind through the map many
/// times. Planes far outside all charts belong to no wall.
void addBeyondCut(const CutGraph& graph, const SharedUnknowns& unknowns, double extent,
                  Planes& planes) {
  const std::vector<adjacency::HalfFace> pieces = unknowns.cutPieces();
  for (std::size_t next = 0; next < planes.size() && planes.size() < kMostPlanes &&
                             next * pieces.size() < kMostIntersections;
       ++next) {
    const FixedCoordinate here = planes[next];
    for (const adjacency::HalfFace h : pieces) {
      const lattice::Direction to =
          graph.rotations[h](lattice::direction(static_cast<int>(here.axis), 1));
      FixedCoordinate there;
      there.axis = static_cast<std::size_t>(lattice::axisOf(to));
      there.form.add(here.form, lattice::signOf(to));
      there.form.add(unknowns.translation(h, there.axis), 2);
      const auto coordinate = 0.5 * static_cast<double>(planes.valueOf(there));
      if (std::abs(coordinate) <= 2 * extent) planes.add(there);
    }
  }
}

}  // namespace

std::vector<IntegerForm> coincidences(const CutGraph& graph, const SharedUnknowns& unknowns,
                                      const std::vector<VertexConditions>& conditions,
                                      std::span<const std::int64_t> values, double noise,
                                      double extent) {
  std::set<FixedCoordinate> fixed;
  for (const VertexConditions& vertex : conditions) collectFixed(vertex, fixed);
  Planes planes(values, noise, extent);
  for (const FixedCoordinate& each : fixed) planes.add(each);
  planes.addAnywhere();
  addBeyondCut(graph, unknowns, extent, planes);
  return std::move(planes).equations();
}

}  // namespace hexhex::quantization
