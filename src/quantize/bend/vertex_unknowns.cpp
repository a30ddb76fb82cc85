#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <quantize/bend/vertex_unknowns.hpp>
#include <tetmap/freedom.hpp>

#include <igm/vertex_star.hpp>

namespace hexhex::quantization {

namespace {

constexpr std::size_t kVertexUnknownsGrain = 256;

using Equations = tetmap::PointEquations<tetmap::KnownRest>;

/// Adds the equation that the image of the point lies in a plane.
void addPlane(const lattice::Transition& toPlane, const BoundaryPlane& plane,
              Equations& equations) {
  const auto axis = static_cast<std::uint8_t>(plane.axis);
  equations.addPlane(toPlane.rotation, axis,
                     {std::int64_t{toPlane.translation[axis]} - plane.coordinate});
}

/// Finds the fixed coordinates.
/// @return false unless the solutions are a point, a line along an axis, a plane across one or the
///         whole space, at integers
bool solve(Equations equations, lattice::AxisSet& fixed, Vec3& position) {
  const Equations::Solution solution = std::move(equations).solve();
  bool good = std::all_of(solution.left.begin(), solution.left.end(),
                          [](const tetmap::KnownRest& rest) { return rest.value == 0; });
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [coefficients, rest] = solution.coordinates[k];
    if (coefficients[k] == 0) continue;
    good = good && coefficients[(k + 1) % 3] == 0 && coefficients[(k + 2) % 3] == 0 &&
           rest.value % coefficients[k] == 0;
    fixed |= 1U << k;
    position[k] = static_cast<double>(-rest.value) / static_cast<double>(coefficients[k]);
  }
  return good;
}

/// Collects the conditions that the star of a vertex imposes.
class StarReader {
 public:
  StarReader(const BendProblem& problem, const adjacency::TetTopology& topology,
             VertexUnknowns& unknowns)
      : problem_(problem), topology_(topology), unknowns_(unknowns) {}

  /// @return whether there is a solution
  bool run(Index vertex) {
    star_.collect(topology_, vertex);
    const auto members = star_.members();
    charts_ = igm::unfoldStar(members, [this](adjacency::HalfFace h) { return across(h); });
    Equations equations;
    unknowns_.fixed[vertex] = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      unknowns_.toCorner[members[i].corner] = charts_[i];
      for (std::size_t k = 0; k < 3; ++k) look(members[i], k, charts_[i], equations);
      const auto fixed = problem_.fixedCorners.find(members[i].corner);
      if (fixed == problem_.fixedCorners.end()) continue;
      for (const BoundaryPlane& plane : fixed->second) addPlane(charts_[i], plane, equations);
    }
    return solve(std::move(equations), unknowns_.fixed[vertex], unknowns_.fixedPosition[vertex]);
  }

 private:
  [[nodiscard]] const lattice::Transition& across(adjacency::HalfFace halfFace) const {
    return problem_.transitions[halfFace];
  }

  void look(const igm::VertexStar::Member& member, std::size_t k, const lattice::Transition& chart,
            Equations& equations) const {
    const adjacency::HalfFace halfFace = member.halfFace(k);
    const BoundaryPlane& plane = problem_.planes[halfFace];
    if (plane.axis >= 0) addPlane(chart, plane, equations);
    if (member.neighbour[k] == kNone) return;
    const lattice::Transition& known = charts_[member.neighbour[k]];
    const lattice::Transition reached = across(halfFace) * chart;
    for (std::size_t axis = 0; axis < 3 && !(reached == known); ++axis) {
      equations.addAgreement(reached.rotation, known.rotation, axis,
                             {std::int64_t{reached.translation[axis]} - known.translation[axis]});
    }
  }

  const BendProblem& problem_;
  const adjacency::TetTopology& topology_;
  VertexUnknowns& unknowns_;
  igm::VertexStar star_;
  std::vector<lattice::Transition> charts_;  ///< per member: from the first member's chart
};

}  // namespace

VertexUnknowns findUnknowns(const BendProblem& problem, const adjacency::TetTopology& topology,
                            Stage& stage) {
  VertexUnknowns unknowns;
  unknowns.fixed.assign(topology.pointCount, lattice::kAllAxes);  // isolated vertices remain fixed
  unknowns.fixedPosition.resize(topology.pointCount);
  unknowns.toCorner.resize(4 * topology.tetCount());
  unknowns.contradictions =
      collectFromBlocks<Index>(stage, topology.pointCount, kVertexUnknownsGrain,
                               [&](std::size_t begin, std::size_t end, auto& list) {
                                 StarReader reader(problem, topology, unknowns);
                                 for (auto v = static_cast<Index>(begin); v < end; ++v) {
                                   if (!topology.isIsolated(v) && !reader.run(v)) list.push_back(v);
                                 }
                               });
  return unknowns;
}

}  // namespace hexhex::quantization
