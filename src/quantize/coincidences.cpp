#include <algorithm>
#include <set>
#include <tuple>

#include <quantize/coincidences.hpp>

namespace hexhex::quantization {

namespace {

/// So many planes are compared with each other at most.
constexpr std::size_t kMostPlanes = 200'000;

/// In place of an axis: not a coordinate, but a difference.
constexpr std::size_t kMoves = 3;

/// A coordinate that conditions fix, times two.
struct FixedCoordinate {
  std::size_t axis = 0;
  IntegerForm form;

  [[nodiscard]] auto operator<=>(const FixedCoordinate&) const = default;
};

/// All of a vertex, in the charts of its sectors.
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

/// The same planes as they are beyond pieces of the cut.
std::set<FixedCoordinate> beyondCut(const std::set<FixedCoordinate>& here, const CutGraph& graph,
                                    const SharedUnknowns& unknowns) {
  std::set<FixedCoordinate> all = here;
  for (const adjacency::HalfFace h : unknowns.cutPieces()) {
    for (const FixedCoordinate& fixed : here) {
      const lattice::Direction to =
          graph.rotations[h](lattice::direction(static_cast<int>(fixed.axis), 1));
      FixedCoordinate there;
      there.axis = static_cast<std::size_t>(lattice::axisOf(to));
      there.form.add(fixed.form, lattice::signOf(to));
      there.form.add(unknowns.translation(h, there.axis), 2);
      all.insert(std::move(there));
    }
  }
  return all;
}

/// What ways around move along axes that they do not turn, and nothing: a wall that comes back to
/// its beginning meets it, or misses it by more than noise.
void collectMoves(const CutGraph& graph, const SharedUnknowns& unknowns,
                  std::set<FixedCoordinate>& all) {
  all.insert({kMoves, {}});
  for (const adjacency::HalfFace h : unknowns.cutPieces()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const lattice::Direction d = lattice::direction(static_cast<int>(axis), 1);
      if (graph.rotations[h](d) != d) continue;
      FixedCoordinate move{kMoves, {}};
      move.form.add(unknowns.translation(h, axis), 2);
      all.insert(std::move(move));
    }
  }
}

}  // namespace

std::vector<IntegerForm> coincidences(const CutGraph& graph, const SharedUnknowns& unknowns,
                                      const std::vector<VertexConditions>& conditions,
                                      std::span<const std::int64_t> values, double noise) {
  std::vector<IntegerForm> equations;
  std::set<FixedCoordinate> all;
  for (const VertexConditions& vertex : conditions) collectFixed(vertex, all);
  // Walls cross the cut, some of them twice.
  for (int crossing = 0; crossing < 2; ++crossing) {
    if (all.size() * unknowns.cutPieces().size() > kMostPlanes) break;
    all = beyondCut(all, graph, unknowns);
  }
  collectMoves(graph, unknowns, all);
  std::vector<std::tuple<std::size_t, std::int64_t, const IntegerForm*>> sorted;
  sorted.reserve(all.size());
  for (const FixedCoordinate& each : all) {
    sorted.emplace_back(each.axis, each.form(values), &each.form);
  }
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
  });
  bool isAny = false;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const auto& [axis, value, form] = sorted[i];
    const auto& [otherAxis, otherValue, otherForm] = sorted[i - 1];
    const auto apart = static_cast<double>(value - otherValue);
    if (axis != otherAxis || apart > 2 * noise) continue;
    isAny = isAny || apart != 0;
    equations.push_back(*form);
    equations.back().add(*otherForm, -1);
  }
  // Those that are the same already have to stay so.
  if (!isAny) equations.clear();
  return equations;
}

}  // namespace hexhex::quantization
