// Untangles patches around bad tets, in rounds: larger patches where smaller ones do not suffice,
// then a finer tet mesh. The solver is src/untangle (Garanzha et al. 2021); an exact check decides
// in the end.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <tetmap/split_map.hpp>
#include <untangle/untangle.hpp>

#include <hexhex/repair.hpp>

#include <base/short_number.hpp>
#include <base/vector3.hpp>
#include <igm/igm.hpp>
#include <igm/measures.hpp>
#include <repair/diagnosis.hpp>
#include <repair/patch.hpp>
#include <repair/patch_charts.hpp>
#include <repair/patch_problem.hpp>
#include <repair/repair_errors.hpp>
#include <repair/repair_map.hpp>
#include <repair/valid_tets.hpp>

namespace hexhex::repairs {

namespace {

/// Numbers of rings of tets around bad ones, tried one after another.
constexpr std::array<int, 4> kRings = {2, 3, 5, 8};
/// Maximum number of rounds of splitting edges.
constexpr int kMaxRefinements = 5;
/// Volumes of maps without noise differ by less than this, which is far below a cell, or than this
/// share of them, which is far above rounding.
constexpr double kVolumeSlack = 0.05;
constexpr double kVolumeSlackShare = 0x1p-40;

/// The state of the map at one moment.
struct Snapshot {
  igm::DefectCollector defects;
  igm::PreparedMap prepared;
};

#if defined(HEXHEX_HAS_REPAIR)
constexpr bool kHasSolver = true;
/// Steps that reduce distortion once all tets are positive: they move away from barely legal maps.
constexpr int kPolishing = 300;

/// Moves the unknowns so that tets become positive. The result is examined afterwards.
void movePatch(untangle::Problem& problem, Stage& stage) {
  static_cast<void>(untangle::Solver(problem, stage).run({.polishing = kPolishing}));
}
#else
constexpr bool kHasSolver = false;

void movePatch(untangle::Problem& /*problem*/, Stage& /*stage*/) {}
#endif

TetMap ownedCopy(const TetMapView& map) {
  TetMap copy;
  copy.points.assign(map.points.begin(), map.points.end());
  copy.tets.assign(map.tets.begin(), map.tets.end());
  copy.parameters.assign(map.parameters.begin(), map.parameters.end());
  copy.edgeValences.assign(map.edgeValences.begin(), map.edgeValences.end());
  copy.rotations.assign(map.rotations.begin(), map.rotations.end());
  copy.features = map.features.copy();
  copy.regions.assign(map.regions.begin(), map.regions.end());
  return copy;
}

/// What must be preserved: singular edges around the patches.
using EdgeKey = std::pair<Index, Index>;

class Repairer {
 public:
  Repairer(const TetMapView& given, const RepairOptions& options, Context& context,
           RepairReport& report)
      : given_(given),
        map_(ownedCopy(given)),
        options_(options),
        context_(context),
        report_(report),
        limit_(options.round ? std::max(kRoundingLimit, options.tolerance) : options.tolerance) {}

  TetMap run() {
    look();
    if (now_->defects.empty()) return std::move(map_);
    refuseBrokenTopology();
    if (!canRepair()) throwWithoutSolver(now_->defects);
    std::vector<Index> bad = findStartTets();
    report_.badTets = bad.size();
    prepareExpectation(bad);
    const std::vector<Index> toRound = refuseOtherDefects(bad);
    refuseInvertedRegions(now_->prepared.topology, bad);
    bool fresh = true;  // nothing has been moved yet
    for (int refinement = 0;; ++refinement) {
      for (const int rings : kRings) {
        solve(bad, fresh ? toRound : std::vector<Index>{}, rings);
        look();
        if (now_->defects.empty() && isWhatWasMeant()) return finish();
        bad = findStartTets();
        // All positive and yet wrong, e.g. wound twice around an edge: a larger patch, from
        // scratch.
        fresh = bad.empty();
        if (fresh) bad = startOver();
        if (!locked_.empty()) break;
      }
      if (refinement == kMaxRefinements || !options_.refine || !refine(bad)) {
        throwRemaining(bad.size());
      }
      look();
    }
  }

 private:
  void look() {
    now_ = std::make_unique<Snapshot>();
    now_->prepared =
        igm::prepareMap(map_, options_.tolerance, options_.scale, context_, now_->defects);
  }

  std::vector<Index> startOver() {
    map_ = ownedCopy(given_);
    locked_.clear();
    candidates_.clear();
    moved_.clear();
    valences_.clear();
    report_.regions.clear();
    report_.splitEdges = 0;
    report_.addedTets = 0;
    look();
    return findStartTets();
  }

  [[nodiscard]] igm::LocalParameters parameters() const {
    return igm::LocalParameters(now_->prepared.input);
  }

  /// Refuses what moving parameters cannot repair.
  void refuseBrokenTopology() const {
    if (now_->prepared.exact.corners.empty()) now_->defects.throwIfAny();
  }

  /// Bad tets, or if there are none, those that sanitization flattens.
  std::vector<Index> findStartTets() {
    Stage stage(context_, "defects");
    std::vector<Index> bad = findBadTets(map_.tets.size(), parameters(), stage);
    if (bad.empty()) bad = findExactlyBadTets(now_->prepared.exact, stage);
    return bad;
  }

  /// Moving parameters along free coordinates preserves volume, so the volume of the defective map,
  /// with flipped tets counting as negative, is that of the repaired one.
  void prepareExpectation(const std::vector<Index>& bad) {
    const igm::LocalParameters u = parameters();
    volume_ = 0;
    for (std::size_t t = 0; t < map_.tets.size(); ++t) {
      volume_ += determinantOf(u(static_cast<Index>(t))) / 6;
    }
    refuseInvertedParts(now_->prepared.topology, u, bad);
  }

  /// Conditions violated away from bad tets. Returns tets at vertices that are to be rounded.
  std::vector<Index> refuseOtherDefects(const std::vector<Index>& bad) {
    Diagnosis diagnosis;
    {
      Stage stage(context_, "diagnosis");
      diagnosis.hopeless.setCornersReversed(now_->prepared.input.cornersReversed);
      diagnose(now_->prepared, parameters(), bad, options_.tolerance, limit_, stage, diagnosis);
    }
    if (!diagnosis.hopeless.empty()) throwHopeless(diagnosis.hopeless, bad.size(), options_.round);
    if (bad.empty() && diagnosis.roundable.empty()) now_->defects.throwIfAny();
    report_.roundedVertices = diagnosis.roundable.size();
    std::vector<Index> tets;
    tets.reserve(diagnosis.roundable.size());
    for (const Index v : diagnosis.roundable) {
      tets.push_back(now_->prepared.topology.vertexTet[v]);
    }
    return tets;
  }

  /// Optimizes the patches around bad tets, one after another.
  void solve(const std::vector<Index>& bad, const std::vector<Index>& toRound, int rings) {
    Stage stage(context_, "repair");
    locked_.clear();
    candidates_.clear();
    std::vector<Index> startTets = bad;
    startTets.insert(startTets.end(), toRound.begin(), toRound.end());
    sortUnique(startTets);
    const igm::LocalParameters u = parameters();
    for (const std::vector<Index>& region :
         separateRegions(now_->prepared.topology, startTets, rings)) {
      context_.throwIfCancelled();
      solveRegion(region, u, rings, stage);
    }
  }

  void solveRegion(const std::vector<Index>& region, const igm::LocalParameters& u, int rings,
                   Stage& stage) {
    const TetMapView& view = now_->prepared.input.view;
    const adjacency::TetTopology& topology = now_->prepared.topology;
    const Patch patch = growPatch(topology, region, rings);
    const PatchCharts charts(view, topology, u, patch, limit_);
    if (const PatchEdge* edge = charts.impossibleEdge()) throwImpossible(*edge);
    std::vector<PatchVertex> vertices = findFreedom(u, patch, charts);
    refuseOffLattice(vertices, limit_, options_.round);
    PatchProblem problem(view, topology, u, patch, vertices);
    noteEdges(charts);
    const std::vector<LockedTet> locked = problem.lockedTets(patch);
    if (!locked.empty() && options_.refine) {
      noteLocked(locked, charts);
      // Locked tets stay locked; there is no point in moving anything yet.
      if (!locked_.empty()) return;
    }
    movePatch(problem.problem(), stage);
    noteSplitCandidates(patch, charts);
    write(problem, vertices, patch);
  }

  /// The valences that edges of a patch must finally have, according to the latest patch.
  void noteEdges(const PatchCharts& charts) {
    for (const PatchEdge& edge : charts.edges()) {
      valences_.insert_or_assign({edge.vertex0, edge.vertex1},
                                 edge.singular ? edge.valence : (edge.boundary ? 2 : 4));
    }
  }

  [[nodiscard]] static const PatchEdge* find(const PatchCharts& charts, Index v, Index w) {
    const EdgeKey key = std::minmax(v, w);
    const auto edges = charts.edges();
    const auto found = std::lower_bound(edges.begin(), edges.end(), key,
                                        [](const PatchEdge& edge, const EdgeKey& wanted) {
                                          return EdgeKey(edge.vertex0, edge.vertex1) < wanted;
                                        });
    if (found == edges.end() || EdgeKey(found->vertex0, found->vertex1) != key) return nullptr;
    return &*found;
  }

  /// For locked tets, notes the edges whose midpoints are freer than their ends: interior regular
  /// ones, else regular ones on the boundary.
  void noteLocked(const std::vector<LockedTet>& locked, const PatchCharts& charts) {
    for (const LockedTet& tet : locked) {
      for (const bool boundary : {false, true}) {
        const std::size_t before = locked_.size();
        addEdgesOf(tet.tet, tet.corners, charts, boundary, locked_);
        if (locked_.size() > before) break;
      }
    }
  }

  void addEdgesOf(Index t, lattice::CornerMask corners, const PatchCharts& charts, bool boundary,
                  std::vector<tetmap::EdgeInTet>& list) const {
    const Tet& tet = now_->prepared.topology.tets[t];
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        if (!lattice::contains(corners, a) || !lattice::contains(corners, b)) continue;
        const PatchEdge* const edge =
            find(charts, tet[static_cast<std::size_t>(a)], tet[static_cast<std::size_t>(b)]);
        if (edge == nullptr || edge->singular || edge->boundary != boundary) continue;
        list.push_back({{edge->vertex0, edge->vertex1}, t});
      }
    }
  }

  /// In case all patches fail: the interior edges of bad tets.
  void noteSplitCandidates(const Patch& patch, const PatchCharts& charts) {
    for (const Index t : patch.startTets)
      addEdgesOf(t, lattice::kWholeTet, charts, false, candidates_);
  }

  bool refine(const std::vector<Index>& bad) {
    const std::vector<tetmap::EdgeInTet>& edges = locked_.empty() ? candidates_ : locked_;
    if (edges.empty() || bad.empty()) return false;
    const std::size_t tets = map_.tets.size();
    const std::size_t count = tetmap::splitEdges(map_, now_->prepared.topology, edges);
    report_.splitEdges += count;
    report_.addedTets += map_.tets.size() - tets;
    return count > 0;
  }

  /// Writes the new parameters of a patch in the caller's charts.
  void write(const PatchProblem& problem, const std::vector<PatchVertex>& vertices,
             const Patch& patch) {
    const igm::OrientedMap& input = now_->prepared.input;
    const igm::LocalParameters u = parameters();
    // Fine, but coarse enough to be exact in every chart, however far from the origin.
    const int bits = std::clamp(50 - (std::ilogb(input.largestCoordinate + 1) + 1), 16, 40);
    const double quantum = std::ldexp(1.0, -bits);
    const std::size_t region = regionOf(patch);
    // Collected first, since the local parameters refer to the arrays that are about to change.
    std::vector<std::pair<Vec3*, Vec3>> changes;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (!problem.mayMove(i) && vertices[i].off <= options_.tolerance) continue;
      const Vec3 first = problem.parameterOf(i, quantum);
      for (const PatchVertex::Copy& copy : vertices[i].corners) {
        changes.push_back(changeOf(input, u, copy.corner, copy.fromFirst(first, 1.0)));
      }
      moved_.try_emplace(vertices[i].vertex, region);
    }
    for (const auto& [target, value] : changes) *target = value;
  }

  /// The caller's parameter of a corner, and its new value in the caller's chart.
  std::pair<Vec3*, Vec3> changeOf(const igm::OrientedMap& input, const igm::LocalParameters& u,
                                  adjacency::CornerIndex corner, const Vec3& local) {
    const int c = adjacency::localOf(corner);
    const Index t = adjacency::tetOf(corner);
    const Vec3 chart = minus(input.view.parameters[t][static_cast<std::size_t>(c)], u(t, c));
    Vec3 value = plus(local, chart);
    if (input.mirrored) value[0] = -value[0];
    return {&map_.parameters[t][static_cast<std::size_t>(input.callersCorner(c))], value};
  }

  /// The report's entry for a patch: one that has already moved some of its vertices, or a new one.
  std::size_t regionOf(const Patch& patch) {
    for (const Index v : patch.vertices) {
      const auto found = moved_.find(v);
      if (found != moved_.end()) return found->second;
    }
    RepairedRegion region;
    region.place = {PlaceKind::Tet, patch.startTets.front()};
    for (const Index t : patch.startTets) {
      for (const Index v : now_->prepared.topology.tets[t]) {
        for (std::size_t k = 0; k < 3; ++k) {
          region.position[k] += map_.points[v][k] / static_cast<double>(4 * patch.startTets.size());
        }
      }
    }
    region.badTets = patch.startTets.size();
    region.tets = patch.tets.size();
    report_.regions.push_back(region);
    return report_.regions.size() - 1;
  }

  TetMap finish() {
    describeMoves();
    report_.changed = true;
    return std::move(map_);
  }

  /// Given a valid map, whether it is also the one that was meant. If not, complaint_ says why.
  [[nodiscard]] bool isWhatWasMeant() {
    complaint_.clear();
    const std::uint64_t cells = igm::parametricVolume(now_->prepared.exact);
    // Sanitization moves the boundary; nothing else changes the volume.
    const double slack =
        kVolumeSlack + kVolumeSlackShare * volume_ +
        2 * now_->prepared.exact.maxDisplacement *
            static_cast<double>(igm::boundaryArea(now_->prepared.topology, now_->prepared.exact));
    if (!options_.round && !(std::abs(volume_ - static_cast<double>(cells)) <= slack)) {
      complaint_ = "the volume of the map changed to " + std::to_string(cells) + " cells from " +
                   shortNumber(volume_);
      return false;
    }
    return hasExpectedValences();
  }

  [[nodiscard]] bool isEdge(const EdgeKey& key, igm::VertexStar& star) const {
    const adjacency::TetTopology& topology = now_->prepared.topology;
    star.collect(topology, key.first);
    return std::any_of(star.members().begin(), star.members().end(), [&](const auto& member) {
      const Tet& tet = topology.tets[member.tet()];
      return std::find(tet.begin(), tet.end(), key.second) != tet.end();
    });
  }

  [[nodiscard]] bool hasExpectedValences() {
    std::map<EdgeKey, int> found;
    for (const igm::SingularEdge& edge : now_->prepared.singularities.edges) {
      found[{edge.vertex0, edge.vertex1}] = edge.valence;
    }
    igm::VertexStar star;
    for (const auto& [key, valence] : valences_) {
      // Was it split?
      if (!isEdge(key, star)) continue;
      const auto entry = found.find(key);
      // Without an entry, the edge is regular. Zero stands for singular with unknown valence.
      const bool same = entry == found.end() ? valence == 2 || valence == 4
                                             : valence == 0 || entry->second == valence;
      if (same) continue;
      complaint_ = "edge " + std::to_string(key.first) + "-" + std::to_string(key.second) +
                   " became another singularity than it was";
      return false;
    }
    return true;
  }

  void describeMoves() {
    const igm::OrientedMap& input = now_->prepared.input;
    igm::VertexStar star;
    for (const auto& [vertex, region] : moved_) {
      if (vertex >= given_.points.size()) continue;
      star.collect(now_->prepared.topology, vertex);
      double move = 0;
      for (const igm::VertexStar::Member& member : star.members()) {
        if (member.tet() >= given_.tets.size()) continue;
        const auto c =
            static_cast<std::size_t>(input.callersCorner(adjacency::localOf(member.corner)));
        const Vec3& before = given_.parameters[member.tet()][c];
        const Vec3& after = map_.parameters[member.tet()][c];
        for (std::size_t k = 0; k < 3; ++k) {
          move = std::max(move, std::abs(after[k] - before[k]));
        }
      }
      if (move == 0) continue;
      RepairedRegion& entry = report_.regions[region];
      ++entry.movedVertices;
      entry.largestMove = std::max(entry.largestMove, move);
      ++report_.movedVertices;
      report_.largestMove = std::max(report_.largestMove, move);
    }
  }

  [[noreturn]] void throwRemaining(std::size_t badTets) const {
    std::string message = "The map could not be repaired: ";
    if (!complaint_.empty()) {
      message += "all tets became positive, but " + complaint_ +
                 ", so that it is not the map that was meant";
    } else {
      message += std::to_string(badTets) + " flipped or flat tets remained of " +
                 std::to_string(report_.badTets) + " and what came of splitting them";
    }
    message += ", after patches of up to " + std::to_string(kRings.back()) + " rings and " +
               std::to_string(report_.splitEdges) +
               " split edges. Compute the map again with more tets there, or extract what can be "
               "extracted (--partial).";
    const std::vector<Defect> defects = now_->defects.defects();
    throw Error(ErrorCode::FlippedTet, message,
                defects.empty() || defects.front().worst.empty()
                    ? Place{}
                    : defects.front().worst.front().place);
  }

  const TetMapView& given_;
  TetMap map_;
  const RepairOptions& options_;
  Context& context_;
  RepairReport& report_;
  double limit_;  ///< maximum distance of coordinates from integers
  std::unique_ptr<Snapshot> now_;
  double volume_ = 0;      ///< of the defective map
  std::string complaint_;  ///< why the last valid map was rejected
  std::map<EdgeKey, int> valences_;
  std::map<Index, std::size_t> moved_;         ///< vertices, and their region in the report
  std::vector<tetmap::EdgeInTet> locked_;      ///< edges whose splitting unlocks tets
  std::vector<tetmap::EdgeInTet> candidates_;  ///< edges to split when all else has failed
};

}  // namespace

}  // namespace hexhex::repairs

namespace hexhex {

bool canRepair() noexcept { return repairs::kHasSolver; }

}  // namespace hexhex

namespace hexhex::repairs {

TetMap repairInArena(const TetMapView& map, const RepairOptions& options, Context& context,
                     RepairReport& report) {
  constexpr std::array<WorkStep, 5> kSteps = {
      {{"prepare", 1}, {"defects", 0.1}, {"diagnosis", 0.5}, {"repair", 10}, {"prepare", 1}}};
  WorkSteps steps(context, "repair", kSteps);
  report = {};
  const auto begin = std::chrono::steady_clock::now();
  const auto stop = [&] {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    report.seconds = seconds.count();
  };
  try {
    TetMap repaired = Repairer(map, options, context, report).run();
    stop();
    steps.finish();
    return repaired;
  } catch (...) {
    stop();
    throw;
  }
}

}  // namespace hexhex::repairs

namespace hexhex {

TetMap repair(const TetMap& map, const RepairOptions& options, Context& context,
              RepairReport* report) {
  RepairReport local;
  TetMap repaired;
  withThreads(context.threads(), [&] {
    repaired = repairs::repairInArena(map, options, context, report != nullptr ? *report : local);
  });
  return repaired;
}

TetMap repair(const TetMap& map, const RepairOptions& options) {
  Context context;
  return repair(map, options, context);
}

}  // namespace hexhex
