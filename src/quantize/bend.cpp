#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <quantize/bend.hpp>
#include <quantize/bend_split.hpp>
#include <quantize/edge_turns.hpp>
#include <quantize/newton.hpp>

#include <lattice/tet_geometry.hpp>

namespace hexhex {

namespace {

/// More rounds of splitting have not helped any map.
constexpr int kMostRounds = 16;
/// Coordinates are multiples of 2^-30: sanitization keeps them exactly up to 2^22, and if the map
/// is going to be scaled by some hundreds.
constexpr int kFractionBits = 30;
/// Of tets around flipped ones that may move to make room for them.
constexpr int kRings = 4;

/// One mesh and its unknowns: what is new after each round of splitting.
class Round {
 public:
  Round(BendState& state, Stage& stage) : state_(state), stage_(stage) {
    topology_.tets = state.problem.tets;
    topology_.pointCount = state.problem.points.size();
    if (!matchFaces(topology_, stage)) {
      throw Error(ErrorCode::Internal, "What is to be bent is no manifold.");
    }
    addStars(topology_, stage);
    unknowns_ = findUnknowns(state.problem, topology_, stage);
  }

  [[nodiscard]] const TetTopology& topology() const noexcept { return topology_; }
  [[nodiscard]] const VertexUnknowns& unknowns() const noexcept { return unknowns_; }

  /// From now on, only vertices near these tets move.
  void moveOnlyNear(std::span<const Index> tets) {
    std::vector<bool> isNear(topology_.pointCount, false);
    std::vector<Index> region(tets.begin(), tets.end());
    for (int ring = 0; ring < kRings; ++ring) region = withNeighbours(topology_, region);
    for (const Index t : region) {
      for (const Index v : topology_.tets[t]) isNear[v] = true;
    }
    for (Index v = 0; v < topology_.pointCount; ++v) {
      if (isNear[v] || topology_.isIsolated(v)) continue;
      unknowns_.fixed[v] = kAllAxes;
      unknowns_.fixedPosition[v] = representative(v);
    }
  }

  /// Bends the tets and rounds their corners. Fills `bent`, and what the map knows of this.
  /// @param isFresh  not from where they are bent to
  /// @return whether nothing good comes from going on from there: tets are positive, but wind
  bool run(bool isFresh, int polishing, BentMap& map) {
    BendEnergy energy(topology_, state_.problem.reference, unknowns_);
    Vector x = isFresh ? Vector(Vector::Zero(energy.unknownCount())) : unknownsOf(energy);
    map.iterations += solve(energy, isFresh, polishing, x);
    map.flippedTets = round(energy, x);
    map.energy = energy.value({BendEnergyKind::Name::FoldoverFree, 0}, x, stage_);
    map.isWound = false;
    if (!map.flippedTets.empty()) return false;
    map.flippedTets =
        tetsAtOtherTurns(topology_, state_.problem.irregularEdges, state_.bent, stage_);
    map.isWound = !map.flippedTets.empty();
    return map.isWound;
  }

 private:
  /// @return Newton steps
  int solve(BendEnergy& energy, bool isFresh, int polishing, Vector& x) {
    NewtonSolver solver(energy, stage_);
    if (isFresh) solver.start(x);
    energy.adaptScale(x);
    if (isFresh) solver.start(x);  // again, towards shapes of the right size
    if (untangle(solver, isFresh, x)) solver.polish(x, polishing);
    return solver.iterations();
  }

  /// After a split, most of the map is good: a small penalty leaves it so, and often suffices.
  static bool untangle(NewtonSolver& solver, bool isFresh, Vector& x) {
    return isFresh ? solver.untangle(x, 1) : solver.untangle(x, 1e-3) || solver.untangle(x, 0.1);
  }

  [[nodiscard]] const Vec3& representative(Index v) const {
    const Index t = topology_.vertexTet[v];
    return state_.bent[t][static_cast<std::size_t>(topology_.localCorner(t, v))];
  }

  [[nodiscard]] Vector unknownsOf(const BendEnergy& energy) const {
    Vector x(energy.unknownCount());
    for (Index v = 0; v < topology_.pointCount; ++v) {
      if (unknowns_.fixed[v] == kAllAxes) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (energy.unknownsOf(v)[k] >= 0) x[energy.unknownsOf(v)[k]] = representative(v)[k];
      }
    }
    return x;
  }

  /// Rounds unknowns, and derives all corners.
  /// @return tets that are not positive, exactly
  std::vector<Index> round(const BendEnergy& energy, Vector& x) {
    constexpr double kUnit = 1 << kFractionBits;
    for (double& value : x) value = std::nearbyint(value * kUnit) / kUnit;
    state_.bent.resize(topology_.tetCount());
    return collectFromBlocks<Index>(
        stage_, topology_.tetCount(), 1024, [&](std::size_t begin, std::size_t end, auto& list) {
          for (auto t = static_cast<Index>(begin); t < end; ++t) {
            const auto columns = energy.corners(t, x);
            LatticeTet lattice;
            for (std::size_t i = 0; i < 4; ++i) {
              for (std::size_t k = 0; k < 3; ++k) {
                const double u =
                    columns(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
                state_.bent[t][i][k] = u;
                lattice[i][k] = static_cast<std::int64_t>(u * kUnit);
              }
            }
            if (orientation(lattice[0], lattice[1], lattice[2], lattice[3]) <= 0) list.push_back(t);
          }
        });
  }

  BendState& state_;
  Stage& stage_;
  TetTopology topology_;
  VertexUnknowns unknowns_;
};

BendState initialState(BendProblem problem) {
  BendState state;
  state.problem = std::move(problem);
  state.parentTet.resize(state.problem.tets.size());
  std::iota(state.parentTet.begin(), state.parentTet.end(), Index{0});
  return state;
}

}  // namespace

BentMap bend(BendProblem problem, const BendOptions& options, Stage& stage) {
  const auto mostTets = static_cast<std::size_t>(
      std::floor(options.maxGrowth * static_cast<double>(problem.tets.size())));
  BendState state = initialState(std::move(problem));
  BentMap map;
  bool isFresh = true;
  bool isLocal = false;
  for (map.rounds = 1; map.rounds <= kMostRounds; ++map.rounds) {
    Round round(state, stage);
    map.contradictions = round.unknowns().contradictions;
    if (!map.contradictions.empty()) break;
    isLocal = !isFresh && !map.flippedTets.empty();
    if (isLocal) round.moveOnlyNear(map.flippedTets);
    isFresh = round.run(isFresh, options.polishing, map);
    if (map.flippedTets.empty() && !isLocal) break;
    // What is flipped gets a second try, more exactly and without the rest, before it is split; the
    // whole map is polished in the end.
    if (map.flippedTets.empty() || !(isLocal || isFresh)) continue;
    const auto edges =
        edgesToSplit(state.problem, round.topology(), round.unknowns(), map.flippedTets);
    if (!splitEdges(state, edges, mostTets)) break;
  }
  map.points = std::move(state.problem.points);
  map.tets = std::move(state.problem.tets);
  map.reference = std::move(state.problem.reference);
  map.parentTet = std::move(state.parentTet);
  map.splitEdges = std::move(state.splitEdges);
  if (map.contradictions.empty()) map.parameters = std::move(state.bent);
  return map;
}

}  // namespace hexhex
