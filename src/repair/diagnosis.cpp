#include <algorithm>
#include <cmath>
#include <string>

#include <igm/transition_fit.hpp>
#include <igm/vertex_star.hpp>
#include <repair/diagnosis.hpp>
#include <repair/patch.hpp>
#include <repair/valid_tets.hpp>

namespace hexhex::repairs {

namespace {

constexpr std::size_t kDiagnosisGrain = 4096;

class Examiner {
 public:
  Examiner(const igm::PreparedMap& map, const igm::LocalParameters& parameters,
           const std::vector<Index>& bad, double tolerance, double limit)
      : map_(map), parameters_(parameters), tolerance_(tolerance), limit_(limit) {
    touched_.assign(map.topology.pointCount, 0);
    boundary_.assign(map.topology.pointCount, 0);
    for (const Index t : bad) touch(t);
    // Inexact maps have flat tets that count as positive in the input: their angles are
    // meaningless.
    const double noise = std::min(tolerance, map.exact.transitions.maxResidual);
    if (!(noise > 0)) return;
    for (std::size_t t = 0; t < map.topology.tetCount(); ++t) {
      if (isThin(parameters(static_cast<Index>(t)), noise)) touch(static_cast<Index>(t));
    }
  }

  /// How far sanitization moves each vertex.
  void examineVertices(Stage& stage, Diagnosis& diagnosis) {
    const adjacency::TetTopology& topology = map_.topology;
    const auto unit = static_cast<double>(map_.exact.unit);
    Array<double> displacement(topology.pointCount);
    std::fill(displacement.begin(), displacement.end(), 0.0);
    for (std::size_t t = 0; t < topology.tetCount(); ++t) {
      for (std::size_t c = 0; c < 4; ++c) {
        const Index v = topology.tets[t][c];
        displacement[v] =
            std::max(displacement[v],
                     igm::displacementOf(parameters_(static_cast<Index>(t), static_cast<int>(c)),
                                         map_.exact.corners[t][c], unit));
        if (topology.mate[4 * t + c] != kNone) continue;
        for (std::size_t k = 0; k < 4; ++k) {
          if (k != c) boundary_[topology.tets[t][k]] = 1;
        }
      }
    }
    stage.context().throwIfCancelled();
    for (Index v = 0; v < displacement.size(); ++v) {
      if (touched_[v] != 0 || displacement[v] <= tolerance_) continue;
      if (displacement[v] <= limit_) {
        diagnosis.roundable.push_back(v);
      } else {
        diagnosis.hopeless.add(causeAt(v), {PlaceKind::Vertex, v}, displacement[v]);
      }
    }
  }

  /// Whether transitions map triangles onto each other.
  void examineFaces(Stage& stage, Diagnosis& diagnosis) {
    const adjacency::TetTopology& topology = map_.topology;
    parallelFor(stage, topology.tetCount(), kDiagnosisGrain, [&](std::size_t t) {
      for (int f = 0; f < 4; ++f) {
        const adjacency::HalfFace halfFace = adjacency::halfFaceOf(static_cast<Index>(t), f);
        if (topology.mate[halfFace] == kNone || topology.mate[halfFace] < halfFace) continue;
        if (isTouched(halfFace) || isCarriedOver(map_, halfFace)) continue;
        diagnosis.hopeless.add(ErrorCode::HalfIntegerFixedPoint,
                               {PlaceKind::Face, t, static_cast<std::uint64_t>(f)}, 0);
      }
    });
    for (const igm::Transitions::Misfit& misfit : map_.exact.transitions.misfits) {
      // A triangle's own corners tell whether it fits, even where its tets are flipped. The nearest
      // rotation need not be the one that fits best with an integer translation.
      const double residual =
          igm::fitAllTransitions(igm::SharedTriangle(topology, parameters_, misfit.halfFace))
              .front()
              .residual;
      if (residual <= tolerance_) continue;
      if (residual <= limit_) {
        for (const int c : lattice::kFaceCorners[misfit.halfFace % 4]) {
          diagnosis.roundable.push_back(
              topology.tets[adjacency::tetOf(misfit.halfFace)][static_cast<std::size_t>(c)]);
        }
      } else {
        diagnosis.hopeless.add(
            ErrorCode::TransitionResidual,
            {PlaceKind::Face, adjacency::tetOf(misfit.halfFace), misfit.halfFace % 4}, residual);
      }
    }
  }

 private:
  void touch(Index tet) {
    for (const Index v : map_.topology.tets[tet]) touched_[v] = 1;
  }

  [[nodiscard]] ErrorCode causeAt(Index v) const {
    if (map_.singularities.degree(v) > 0) return ErrorCode::SingularityOffLattice;
    return boundary_[v] != 0 ? ErrorCode::BoundaryOffLattice : ErrorCode::TransitionResidual;
  }

  [[nodiscard]] bool isTouched(adjacency::HalfFace halfFace) const {
    const Tet& tet = map_.topology.tets[adjacency::tetOf(halfFace)];
    return std::any_of(lattice::kFaceCorners[halfFace % 4].begin(),
                       lattice::kFaceCorners[halfFace % 4].end(),
                       [&](int c) { return touched_[tet[static_cast<std::size_t>(c)]] != 0; });
  }

  const igm::PreparedMap& map_;
  const igm::LocalParameters& parameters_;
  double tolerance_;
  double limit_;
  std::vector<std::uint8_t> touched_;  ///< per vertex: it belongs to a bad tet
  std::vector<std::uint8_t> boundary_;
};

/// If the share and the number of bad tets both exceed these limits, they are no local defect.
constexpr double kMaxBadShare = 0.2;
/// The same number limits a connected region of bad tets some of which have no good tet around
/// them.
constexpr std::size_t kMaxBadTets = 200;

std::string tetsAsText(std::size_t count) {
  return count == 1 ? "1 tet" : std::to_string(count) + " tets";
}

void refuseInvertedComponents(const adjacency::TetTopology& topology,
                              const igm::LocalParameters& parameters) {
  DisjointSets sets = componentsOf(topology, [](Index) { return true; });
  std::vector<double> volume(topology.tetCount(), 0);  // by the smallest tet of a component
  std::vector<Index> count(topology.tetCount(), 0);
  for (Index t = 0; t < topology.tetCount(); ++t) {
    const Index root = sets.find(t);
    volume[root] += determinantOf(parameters(t)) / 6;
    ++count[root];
  }
  for (Index t = 0; t < topology.tetCount(); ++t) {
    if (count[t] == 0 || volume[t] > 0) continue;
    throw Error(
        ErrorCode::FlippedTet,
        "The component of the mesh with tet " + std::to_string(t) + " (" + tetsAsText(count[t]) +
            " of " + std::to_string(topology.tetCount()) +
            ") is inverted or collapsed as a whole: its volume in the map, in which flipped "
            "tets count negative, is not positive. That is no local defect and is not "
            "repaired; if it is mirrored, negate one parameter of its corners, otherwise "
            "compute the map again.",
        {PlaceKind::Tet, t});
  }
}

/// Whether all tets at the vertices of a tet are bad.
bool isSurrounded(const adjacency::TetTopology& topology, Index tet, const std::vector<Index>& bad,
                  igm::VertexStar& star) {
  const Tet& corners = topology.tets[tet];
  return std::all_of(corners.begin(), corners.end(), [&](Index v) {
    star.collect(topology, v);
    return std::all_of(star.members().begin(), star.members().end(),
                       [&](const igm::VertexStar::Member& member) {
                         return std::binary_search(bad.begin(), bad.end(), member.tet());
                       });
  });
}

}  // namespace

void diagnose(const igm::PreparedMap& map, const igm::LocalParameters& parameters,
              const std::vector<Index>& bad, double tolerance, double limit, Stage& stage,
              Diagnosis& diagnosis) {
  Examiner examiner(map, parameters, bad, tolerance, limit);
  examiner.examineVertices(stage, diagnosis);
  examiner.examineFaces(stage, diagnosis);
  sortUnique(diagnosis.roundable);
}

void refuseInvertedParts(const adjacency::TetTopology& topology,
                         const igm::LocalParameters& parameters, const std::vector<Index>& bad) {
  if (bad.empty()) return;
  refuseInvertedComponents(topology, parameters);
  const auto tets = static_cast<double>(topology.tetCount());
  if (bad.size() > kMaxBadTets && static_cast<double>(bad.size()) > kMaxBadShare * tets) {
    throw Error(ErrorCode::FlippedTet,
                std::to_string(bad.size()) + " of " + tetsAsText(topology.tetCount()) +
                    " are flipped or flat in the map: whole regions of it are inverted or "
                    "collapsed. That is no local defect and is not repaired; compute the map "
                    "again.",
                {PlaceKind::Tet, bad.front()});
  }
}

void refuseInvertedRegions(const adjacency::TetTopology& topology, const std::vector<Index>& bad) {
  if (bad.size() <= kMaxBadTets) return;
  DisjointSets sets = componentsOf(
      topology, [&](Index t) { return std::binary_search(bad.begin(), bad.end(), t); });
  std::vector<Index> roots;
  roots.reserve(bad.size());
  for (const Index t : bad) roots.push_back(sets.find(t));
  std::sort(roots.begin(), roots.end());
  igm::VertexStar star;
  for (const Index t : bad) {
    const auto [first, last] = std::equal_range(roots.begin(), roots.end(), sets.find(t));
    const auto size = static_cast<std::size_t>(last - first);
    if (size <= kMaxBadTets || !isSurrounded(topology, t, bad, star)) continue;
    throw Error(ErrorCode::FlippedTet,
                "A whole region of the map is inverted or collapsed: " + tetsAsText(size) +
                    " around tet " + std::to_string(t) +
                    ", which has no positive tet near. That is no local defect and is not "
                    "repaired; compute the map again, there at least.",
                {PlaceKind::Tet, t});
  }
}

}  // namespace hexhex::repairs
