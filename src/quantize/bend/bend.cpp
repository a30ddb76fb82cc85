#include <cmath>
#include <numeric>
#include <utility>

#include <quantize/bend/bend.hpp>
#include <quantize/bend/bend_split.hpp>
#include <quantize/bend/edge_turns.hpp>
#include <quantize/bend/vertex_unknowns.hpp>
#include <untangle/untangle.hpp>

#include <base/vector3.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::quantization {

namespace {

/// More rounds of splitting have not helped any map.
constexpr int kMostRounds = 16;
/// Coordinates are multiples of 2^-30: sanitization preserves them exactly up to 2^22, and up to
/// scales of some hundreds.
constexpr int kFractionBits = 30;
/// Number of rings of tets around flipped ones that may move to make room.
constexpr int kRings = 4;

/// Edges of a tet from its first corner.
std::array<Vec3, 3> edgesOf(const TetParameters& u) {
  return {minus(u[1], u[0]), minus(u[2], u[0]), minus(u[3], u[0])};
}

double determinantOf(const std::array<Vec3, 3>& edges) {
  return tripleProduct(edges[0], edges[1], edges[2]);
}

/// One mesh and its unknowns; rebuilt after each round of splitting.
class Round {
 public:
  Round(BendState& state, Stage& stage) : state_(state), stage_(stage) {
    auto topology =
        adjacency::manifoldTopology(state.problem.tets, state.problem.points.size(), stage);
    if (!topology) throw Error(ErrorCode::Internal, "What is to be bent is no manifold.");
    topology_ = std::move(*topology);
    adjacency::addStars(topology_, stage);
    unknowns_ = findUnknowns(state.problem, topology_, stage);
  }

  [[nodiscard]] const adjacency::TetTopology& topology() const noexcept { return topology_; }
  [[nodiscard]] const VertexUnknowns& unknowns() const noexcept { return unknowns_; }

  /// What keeps these tets flat given the integers alone, regardless of which vertices may
  /// currently move.
  [[nodiscard]] Tightness tightness(std::span<const Index> tets) const {
    return findTightness(findUnknowns(state_.problem, topology_, stage_), topology_, tets);
  }

  /// Restricts further moves to vertices near these tets.
  void moveOnlyNear(std::span<const Index> tets) {
    std::vector<bool> isNear(topology_.pointCount, false);
    std::vector<Index> region(tets.begin(), tets.end());
    for (int ring = 0; ring < kRings; ++ring) region = withNeighbours(topology_, region);
    for (const Index t : region) {
      for (const Index v : topology_.tets[t]) isNear[v] = true;
    }
    for (Index v = 0; v < topology_.pointCount; ++v) {
      if (isNear[v] || topology_.isIsolated(v)) continue;
      unknowns_.fixed[v] = lattice::kAllAxes;
      unknowns_.fixedPosition[v] = representative(v);
    }
  }

  /// Bends the tets and rounds their corners. Sets `bent` of the state and the results in the map.
  /// @param isFresh  whether to ignore the current `bent` and start anew
  /// @return whether continuing from the result is useless: all tets are positive, but overlap
  ///         around edges
  bool run(bool isFresh, int polishing, BentMap& map) {
    untangle::Problem problem = describe(isFresh);
    untangle::Solver solver(problem, stage_);
    if (isFresh) solver.start();
    // After a split, most of the map is good: a small penalty preserves that, and often suffices.
    untangle::Result result = solver.run({.epsilon = isFresh ? 1 : 1e-3, .polishing = polishing});
    map.iterations += result.steps;
    if (!isFresh && !result.flipped.empty()) {
      result = solver.run({.epsilon = 0.1, .polishing = polishing});
      map.iterations += result.steps;
    }
    map.energy = result.energy;
    map.flippedTets = round(problem);
    map.isWound = false;
    if (!map.flippedTets.empty()) return false;
    map.flippedTets =
        tetsAtOtherTurns(topology_, state_.problem.irregularEdges, state_.bent, stage_);
    map.isWound = !map.flippedTets.empty();
    return map.isWound;
  }

 private:
  [[nodiscard]] const Vec3& representative(Index v) const {
    const Index t = topology_.vertexTet[v];
    return state_.bent[t][static_cast<std::size_t>(topology_.localCorner(t, v))];
  }

  /// Numbers the unknowns and sets up the elements. Their target volumes are scaled so that they
  /// add up to that of the bent map, which the integers alone determine: at low densities that is
  /// several times the reference's, and tets would compete for volume.
  untangle::Problem describe(bool isFresh) {
    untangle::Problem problem;
    numbers_.assign(topology_.pointCount, {-1, -1, -1});
    for (Index v = 0; v < topology_.pointCount; ++v) {
      for (std::size_t k = 0; k < 3; ++k) {
        if ((unknowns_.fixed[v] >> k & 1U) != 0) continue;
        numbers_[v][k] = static_cast<int>(problem.x.size());
        problem.x.push_back(isFresh ? 0 : representative(v)[k]);
      }
    }
    problem.elements.resize(topology_.tetCount());
    double volume = 0;
    double bentVolume = 0;
    for (Index t = 0; t < topology_.tetCount(); ++t) {
      untangle::Element& element = problem.elements[t];
      for (std::size_t i = 0; i < 4; ++i) element.corners[i] = cornerOf(4 * t + i);
      volume += determinantOf(edgesOf(state_.problem.reference[t]));
      bentVolume += determinantOf(edgesOf(cornersAt(element, problem.x)));
    }
    const double scale = bentVolume > 0 ? std::cbrt(bentVolume / volume) : 1;
    for (Index t = 0; t < topology_.tetCount(); ++t) {
      std::array<Vec3, 3> edges = edgesOf(state_.problem.reference[t]);
      problem.elements[t].weight = determinantOf(edges) / volume;
      for (Vec3& edge : edges) {
        for (double& component : edge) component *= scale;
      }
      problem.elements[t].gradients = untangle::tetGradients(edges);
    }
    return problem;
  }

  [[nodiscard]] untangle::Corner cornerOf(std::size_t corner) const {
    const Index v = topology_.vertex(static_cast<adjacency::CornerIndex>(corner));
    const lattice::Transition& way = unknowns_.toCorner[corner];
    const auto rotation = static_cast<std::size_t>(way.rotation.index());
    untangle::Corner result;
    result.constant = way(unknowns_.fixedPosition[v], 1.0);
    for (std::size_t k = 0; k < 3; ++k) {
      result.unknown[k] = numbers_[v][lattice::detail::kAxisSources.axis[rotation][k]];
      result.sign[k] = lattice::detail::kAxisSources.sign[rotation][k];
    }
    return result;
  }

  static TetParameters cornersAt(const untangle::Element& element, const std::vector<double>& x) {
    return {element.corners[0].at(x.data()), element.corners[1].at(x.data()),
            element.corners[2].at(x.data()), element.corners[3].at(x.data())};
  }

  /// Rounds unknowns and computes all corners from them.
  /// @return tets that are exactly nonpositive
  std::vector<Index> round(untangle::Problem& problem) {
    constexpr double kUnit = 1 << kFractionBits;
    for (double& value : problem.x) value = std::nearbyint(value * kUnit) / kUnit;
    state_.bent.resize(topology_.tetCount());
    return collectFromBlocks<Index>(
        stage_, topology_.tetCount(), 1024, [&](std::size_t begin, std::size_t end, auto& list) {
          for (auto t = static_cast<Index>(begin); t < end; ++t) {
            state_.bent[t] = cornersAt(problem.elements[t], problem.x);
            lattice::LatticeTet lattice;
            for (std::size_t i = 0; i < 4; ++i) {
              for (std::size_t k = 0; k < 3; ++k) {
                lattice[i][k] = static_cast<std::int64_t>(state_.bent[t][i][k] * kUnit);
              }
            }
            if (lattice::orientation(lattice[0], lattice[1], lattice[2], lattice[3]) <= 0)
              list.push_back(t);
          }
        });
  }

  BendState& state_;
  Stage& stage_;
  adjacency::TetTopology topology_;
  VertexUnknowns unknowns_;
  std::vector<std::array<int, 3>> numbers_;  ///< per vertex: unknowns of its representative, or -1
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
    if (!map.flippedTets.empty()) map.tightness = round.tightness(map.flippedTets);
    // Before they are split, flipped tets get a second try in which only vertices near them move;
    // the whole map is optimized at the end.
    if (map.flippedTets.empty() || !(isLocal || isFresh)) continue;
    const auto edges =
        edgesToSplit(state.problem, round.topology(), round.unknowns(), map.flippedTets);
    if (!splitEdges(state, round.topology(), edges, mostTets)) break;
  }
  map.points = std::move(state.problem.points);
  map.tets = std::move(state.problem.tets);
  map.reference = std::move(state.problem.reference);
  map.parentTet = std::move(state.parentTet);
  map.splitEdges = std::move(state.splitEdges);
  if (map.contradictions.empty()) map.parameters = std::move(state.bent);
  return map;
}

}  // namespace hexhex::quantization
