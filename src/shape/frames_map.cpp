#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <quantize/polycube/labelled_mesh.hpp>
#include <shape/counted_faults.hpp>
#include <shape/frames_field.hpp>
#include <shape/frames_map.hpp>
#include <shape/frames_matching.hpp>
#include <shape/frames_rematch.hpp>
#include <shape/frames_space.hpp>
#include <shape/frames_tets.hpp>
#include <untangle/untangle.hpp>

#include <hexhex/error.hpp>

#include <igm/defects.hpp>

namespace hexhex::shape {

namespace {

using adjacency::HalfFace;

/// Number of searches for rotations, each with its own random numbers.
constexpr std::uint64_t kSearches = 4;
/// Number of refinements around flips, each followed by a new attempt.
constexpr int kMostRefinements = 1;
/// Weights of the term that pulls gradients towards frames: while untangling, high enough to keep
/// parts from collapsing, and then lower.
constexpr double kPull = 0.5;
constexpr double kLastPull = 0.1;

/// Seeds of rematching: it may turn the same field into different singular curves.
constexpr std::array<std::uint64_t, 2> kSeeds = {0, 1000};
/// Larger meshes are not refined, nor those whose field admits no mesh: there, refinement has not
/// helped any part yet.
constexpr std::size_t kMostRefined = 8000;

/// Tets with a smooth frame field, and the rotations that turn least between neighbours.
FrameTets tetsWithField(const TetMapView& given, double featureAngle, bool isRefined,
                        Stage& stage) {
  FrameTets tets(
      {{given.points.begin(), given.points.end()}, {given.tets.begin(), given.tets.end()}},
      featureAngle, stage);
  if (isRefined) tets.refine(stage);
  tets.makeRoom(stage);
  tets.frames = frameField(tets, stage);
  matchFrames(tets, stage);
  return tets;
}

/// Attempts to make a map from a field.
class FramesMapper {
 public:
  FramesMapper(const quantization::LabelledMesh& given, FrameTets tets, std::uint64_t seed,
               Stage& stage)
      : stage_(stage), given_(given), seed_(seed), tets_(std::move(tets)) {}

  TetMap run() {
    rematch();
    for (int refinements = 0;; ++refinements) {
      splitAtCurves();
      const EdgeWalks walks(tets_);
      untangle::Problem problem = seamlessProblem(tets_, walks, stage_);
      requireRoom(problem);
      std::vector<Index> flipped = untangleTets(problem);
      if (flipped.empty()) flipped = woundTets(problem, walks);
      if (flipped.empty()) return mapOf(problem);
      if (refinements == kMostRefinements) failFlipped(flipped);
      refineAt(flipped);
    }
  }

 private:
  /// Optimizes rotations of the field.
  /// @throws Error TransitionResidual if the field admits no mesh
  void rematch() {
    const EdgeWalks walks(tets_);
    const std::vector<lattice::Rotation> nearest = tets_.rotations;
    std::vector<FieldDefect> fewest = defectsOf(tets_, walks);
    std::vector<lattice::Rotation> best = nearest;
    for (std::uint64_t seed = 0; seed < kSearches && !(seed > 0 && fewest.empty()); ++seed) {
      // Starts anew or from the best so far, in turns.
      tets_.rotations = seed % 2 == 0 ? nearest : best;
      rematchFrames(tets_, walks, seed_ + seed, stage_);
      std::vector<FieldDefect> defects = defectsOf(tets_, walks);
      if (seed > 0 && defects.size() >= fewest.size()) continue;
      fewest = std::move(defects);
      best = tets_.rotations;
    }
    tets_.rotations = std::move(best);
    if (!fewest.empty()) failUnmeshable(fewest);
    smoothFrames(tets_, stage_);
  }

  /// Splits regular edges between vertices that are bound to curves or the boundary.
  void splitAtCurves() {
    while (true) {
      const EdgeWalks walks(tets_);
      std::vector<bool> isBound(tets_.mesh().points.size());
      std::vector<bool> isSingular(walks.size());
      for (std::size_t edge = 0; edge < walks.size(); ++edge) {
        isSingular[edge] = walks.isBoundary(edge)
                               ? boundaryValence(tets_, walks, edge) != 2
                               : turningAt(tets_, walks, edge).kind != EdgeTurning::Kind::Regular;
        if (!isSingular[edge]) continue;
        for (const Index v : walks[edge]) isBound[v] = true;
      }
      const std::vector<bool> isOuter = tets_.boundaryVertices();
      std::vector<tetmap::EdgeInTet> edges;
      for (std::size_t edge = 0; edge < walks.size(); ++edge) {
        const auto [a, b] = walks[edge];
        const bool isInside = !walks.isBoundary(edge);
        const bool isTight =
            (isBound[a] || (isInside && isOuter[a])) && (isBound[b] || (isInside && isOuter[b]));
        if (!isTight || isSingular[edge]) continue;
        edges.push_back({tetmap::pairOf(a, b), adjacency::tetOf(walks.outs(edge).front())});
      }
      if (edges.empty()) return;
      tets_.split(std::move(edges), stage_);
    }
  }

  void requireRoom(const untangle::Problem& problem) const {
    const std::vector<std::size_t> flat = untangle::flatElements(problem);
    if (flat.empty()) return;
    throw Error(ErrorCode::TransitionResidual,
                "No hexahedral mesh follows the frame field of this object: " +
                    std::to_string(flat.size()) +
                    " tets are flat in every map with its singular curves. Refine the tets there, "
                    "or make a polycube of the object.",
                {PlaceKind::Tet, tets_.parentOf(static_cast<Index>(flat.front()))});
  }

  /// @return tets that stay flipped
  std::vector<Index> untangleTets(untangle::Problem& problem) const {
    untangle::Solver solver(problem, stage_);
    problem.pull = kPull;
    solver.start();
    const untangle::Result result = solver.run({.epsilon = 1, .polishing = 0, .isPatient = true});
    if (!result.flipped.empty()) {
      std::vector<Index> flipped;
      for (const std::size_t t : result.flipped) flipped.push_back(static_cast<Index>(t));
      return flipped;
    }
    problem.pull = kLastPull;
    static_cast<void>(solver.run({.epsilon = 1e-3}));
    return roundUnknowns(problem);
  }

  /// Tets at edges with more or fewer quarter turns in the map than in the field: they are
  /// positive, but wind around the edge once too often.
  [[nodiscard]] std::vector<Index> woundTets(const untangle::Problem& problem,
                                             const EdgeWalks& walks) const {
    const std::vector<TetParameters> parameters = parametersOf(problem);
    std::vector<Index> wound;
    for (std::size_t edge = 0; edge < walks.size(); ++edge) {
      double angle = 0;
      for (const HalfFace h : walks.outs(edge)) {
        const Index t = adjacency::tetOf(h);
        const Tet& tet = tets_.mesh().tets[t];
        const auto cornerOf = [&](Index v) {
          return static_cast<std::size_t>(std::find(tet.begin(), tet.end(), v) - tet.begin());
        };
        angle += dihedralAngle(parameters[t], cornerOf(walks[edge][0]), cornerOf(walks[edge][1]));
      }
      if (isTurnOf(walks, edge, std::lround(2 * angle / std::numbers::pi))) continue;
      for (const HalfFace h : walks.outs(edge)) wound.push_back(adjacency::tetOf(h));
    }
    return wound;
  }

  [[nodiscard]] bool isTurnOf(const EdgeWalks& walks, std::size_t edge, long quarters) const {
    if (walks.isBoundary(edge)) return quarters == boundaryValence(tets_, walks, edge);
    switch (turningAt(tets_, walks, edge).kind) {
      case EdgeTurning::Kind::Regular:
        return quarters == 4;
      case EdgeTurning::Kind::Three:
        return quarters == 3;
      case EdgeTurning::Kind::Five:
        return quarters == 5;
      default:
        return quarters == 2 || quarters == 6;
    }
  }

  /// For each tet near a flip, splits the longest edge at a vertex of a flipped tet.
  void refineAt(const std::vector<Index>& flipped) {
    std::vector<bool> isNear(tets_.mesh().points.size());
    for (const Index t : flipped) {
      for (const Index v : tets_.mesh().tets[t]) isNear[v] = true;
    }
    std::vector<tetmap::EdgeInTet> edges;
    for (Index t = 0; t < tets_.size(); ++t) {
      const Tet& tet = tets_.mesh().tets[t];
      if (std::count_if(tet.begin(), tet.end(), [&](Index v) { return isNear[v]; }) < 2) continue;
      VertexPair longest{};
      double most = 0;
      tetmap::forEachEdgeOf(tet, [&](const VertexPair& edge, lattice::CornerMask /*corners*/) {
        if (!isNear[edge[0]] && !isNear[edge[1]]) return;
        const double length = (tets_.point(edge[1]) - tets_.point(edge[0])).norm();
        if (length <= most) return;
        most = length;
        longest = edge;
      });
      edges.push_back({longest, t});
    }
    tets_.split(std::move(edges), stage_);
  }

  [[nodiscard]] TetMap mapOf(const untangle::Problem& problem) const {
    TetMap map{.points = tets_.mesh().points,
               .tets = tets_.mesh().tets,
               .parameters = parametersOf(problem)};
    const TetMapView& given = given_.input.view;
    tetmap::carryTags(given.features, given.regions, tets_.added(), tets_.parents(), map);
    return map;
  }

  /// The edge or vertex if the caller's mesh has it, otherwise a tet there.
  [[nodiscard]] Place placeOf(const VertexPair& edge) const {
    const std::size_t known = given_.input.view.points.size();
    if (edge[0] < known && edge[1] < known) {
      if (edge[0] == edge[1]) return {PlaceKind::Vertex, edge[0]};
      return {PlaceKind::Edge, edge[0], edge[1]};
    }
    return {PlaceKind::Tet, tets_.parentOf(tets_.topology().vertexTet[std::max(edge[0], edge[1])])};
  }

  [[noreturn]] void failUnmeshable(const std::vector<FieldDefect>& defects) const {
    const auto count = [&](FieldDefect::Kind kind) {
      return static_cast<std::uint64_t>(
          std::count_if(defects.begin(), defects.end(),
                        [kind](const FieldDefect& defect) { return defect.kind == kind; }));
    };
    using enum FieldDefect::Kind;
    throw Error(
        ErrorCode::TransitionResidual,
        "No hexahedral mesh follows the frame field of this object. It has " +
            countedFaults({{"edges that turn about a diagonal", count(Compound)},
                           {"vertices where curves meet as in no hexahedral mesh", count(Zipper)},
                           {"edges of the boundary that turn as no hexahedra do", count(Boundary)},
                           {"places where two singular curves run into one",
                            count(Flat) + count(HalfTurn)}}) +
            ". Refine the tets there, or make a polycube of the object.",
        placeOf(defects.front().edge));
  }

  [[noreturn]] void failFlipped(const std::vector<Index>& flipped) const {
    throw Error(
        ErrorCode::FlippedTet,
        "No map was found along the frame field of this object: " + std::to_string(flipped.size()) +
            " tets stay flipped, or go around an edge too often, this one among them. Refine the "
            "tets there, or make a polycube of the object.",
        {PlaceKind::Tet, tets_.parentOf(flipped.front())});
  }

  Stage& stage_;
  const quantization::LabelledMesh& given_;
  std::uint64_t seed_;
  FrameTets tets_;
};

quantization::LabelledMesh read(const TetMesh& tets, Stage& stage) {
  quantization::LabelledMesh mesh = quantization::readUnlabelled(tets, stage);
  // Walks around edges terminate only on manifolds.
  igm::DefectCollector defects;
  igm::collectTopologyDefects(mesh.topology, stage, defects);
  defects.throwIfAny();
  return mesh;
}

}  // namespace

TetMap mapFromFrames(const TetMesh& tets, double featureAngleInDegrees, Stage& stage) {
  const quantization::LabelledMesh given = read(tets, stage);
  std::optional<Error> first;
  bool mayBeTooCoarse = false;
  for (const bool isRefined : {false, true}) {
    if (isRefined && (!mayBeTooCoarse || tets.tets.size() > kMostRefined)) break;
    const FrameTets field =
        tetsWithField(given.input.view, featureAngleInDegrees, isRefined, stage);
    for (const std::uint64_t seed : kSeeds) {
      if (isRefined && seed != kSeeds.front()) break;
      try {
        return FramesMapper(given, field, seed, stage).run();
      } catch (const Error& error) {
        if (error.code() != ErrorCode::TransitionResidual && error.code() != ErrorCode::FlippedTet)
          throw;
        mayBeTooCoarse |= error.code() == ErrorCode::FlippedTet;
        if (!first) first = error;
      }
    }
  }
  throw Error(*first);
}

}  // namespace hexhex::shape
