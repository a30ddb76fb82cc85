#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include <quantize/bend/vertex_unknowns.hpp>

#include <igm/vertex_star.hpp>

namespace hexhex::quantization {

namespace {

constexpr std::size_t kVertexUnknownsGrain = 256;

/// Linear equations of a point, in reduced echelon form. Exact: coefficients are -2 to 2 at first,
/// and rows are divided by their common divisors.
class PointEquations {
 public:
  /// The coefficients of the coordinates, and the right side.
  using Row = std::array<std::int64_t, 4>;

  void add(Row row) {
    for (std::size_t k = 0; k < 3; ++k) eliminate(row, k);
    const auto pivot = std::find_if(row.begin(), row.begin() + 3, [](auto c) { return c != 0; });
    if (pivot == row.begin() + 3) {
      contradictory_ = contradictory_ || row[3] != 0;
      return;
    }
    const auto axis = static_cast<std::size_t>(pivot - row.begin());
    rows_[axis] = reduced(row);
    for (std::size_t k = 0; k < 3; ++k) {
      if (k != axis) eliminate(rows_[k], axis);
    }
  }

  /// The coordinates that are determined; false if that is not a point, a line along an axis or a
  /// plane across one, at integers.
  [[nodiscard]] bool solve(lattice::AxisSet& fixed, Vec3& position) const {
    bool good = !contradictory_;
    for (std::size_t k = 0; k < 3; ++k) {
      const Row& row = rows_[k];
      if (row[k] == 0) continue;
      good = good && row[(k + 1) % 3] == 0 && row[(k + 2) % 3] == 0 && row[3] % row[k] == 0;
      fixed |= 1U << k;
      position[k] = static_cast<double>(row[3]) / static_cast<double>(row[k]);
    }
    return good;
  }

 private:
  /// Makes the coefficient of a coordinate zero, if there is an equation for that.
  void eliminate(Row& row, std::size_t axis) const {
    const Row& other = rows_[axis];
    if (row[axis] == 0 || other[axis] == 0) return;
    const std::int64_t factor = row[axis];
    for (std::size_t i = 0; i < 4; ++i) row[i] = row[i] * other[axis] - factor * other[i];
    row = reduced(row);
  }

  static Row reduced(Row row) {
    std::int64_t divisor = 0;
    for (const std::int64_t entry : row) divisor = std::gcd(divisor, entry);
    for (std::int64_t& entry : row) entry /= std::max<std::int64_t>(divisor, 1);
    return row;
  }

  std::array<Row, 3> rows_{};  ///< by pivot; zero where there is none
  bool contradictory_ = false;
};

/// A coordinate of a point's image, as coefficients of the point's own.
PointEquations::Row coordinateOf(lattice::Rotation rotation, std::size_t axis) {
  PointEquations::Row row{};
  for (std::size_t i = 0; i < 3; ++i) {
    lattice::GridPoint unit{};
    unit[i] = 1;
    row[i] = rotation(unit)[axis];
  }
  return row;
}

/// Demands that a transition leaves the point where it is.
void addFixedPoint(const lattice::Transition& loop, PointEquations& equations) {
  for (std::size_t k = 0; k < 3; ++k) {
    PointEquations::Row row = coordinateOf(loop.rotation, k);
    --row[k];
    row[3] = -std::int64_t{loop.translation[k]};
    equations.add(row);
  }
}

/// Demands that the image of the point lies in a plane.
void addPlane(const lattice::Transition& toPlane, const BoundaryPlane& plane,
              PointEquations& equations) {
  const auto axis = static_cast<std::uint8_t>(plane.axis);
  PointEquations::Row row = coordinateOf(toPlane.rotation, axis);
  row[3] = std::int64_t{plane.coordinate} - toPlane.translation[axis];
  equations.add(row);
}

/// What the star of one vertex demands.
class StarReader {
 public:
  StarReader(const BendProblem& problem, const adjacency::TetTopology& topology,
             VertexUnknowns& unknowns)
      : problem_(problem), topology_(topology), unknowns_(unknowns) {}

  /// @return whether there is a point
  bool run(Index vertex) {
    star_.collect(topology_, vertex);
    const auto members = star_.members();
    charts_.assign(members.size(), {});
    for (std::size_t i = 1; i < members.size(); ++i) {
      const adjacency::HalfFace back = members[i].halfFace(members[i].entry);
      charts_[i] = across(topology_.mate[back]) * charts_[members[i].neighbour[members[i].entry]];
    }
    PointEquations equations;
    unknowns_.fixed[vertex] = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      unknowns_.toCorner[members[i].corner] = charts_[i];
      for (std::size_t k = 0; k < 3; ++k) look(members[i], k, charts_[i], equations);
      const auto fixed = problem_.fixedCorners.find(members[i].corner);
      if (fixed == problem_.fixedCorners.end()) continue;
      for (const BoundaryPlane& plane : fixed->second) addPlane(charts_[i], plane, equations);
    }
    return equations.solve(unknowns_.fixed[vertex], unknowns_.fixedPosition[vertex]);
  }

 private:
  [[nodiscard]] const lattice::Transition& across(adjacency::HalfFace halfFace) const {
    return problem_.transitions[halfFace];
  }

  void look(const igm::VertexStar::Member& member, std::size_t k, const lattice::Transition& chart,
            PointEquations& equations) const {
    const adjacency::HalfFace halfFace = member.halfFace(k);
    const BoundaryPlane& plane = problem_.planes[halfFace];
    if (plane.axis >= 0) addPlane(chart, plane, equations);
    if (member.neighbour[k] == kNone) return;
    const lattice::Transition loop =
        charts_[member.neighbour[k]].inverse() * (across(halfFace) * chart);
    if (!loop.isIdentity()) addFixedPoint(loop, equations);
  }

  const BendProblem& problem_;
  const adjacency::TetTopology& topology_;
  VertexUnknowns& unknowns_;
  igm::VertexStar star_;
  std::vector<lattice::Transition> charts_;  ///< per member: from the first one's chart
};

}  // namespace

VertexUnknowns findUnknowns(const BendProblem& problem, const adjacency::TetTopology& topology,
                            Stage& stage) {
  VertexUnknowns unknowns;
  unknowns.fixed.assign(topology.pointCount, lattice::kAllAxes);  // isolated vertices stay so
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
