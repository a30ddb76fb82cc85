// Bends a seamless map onto integers chosen for it, without flipped tets: the last step of
// quantization. Minimizes the foldover-free energy of Garanzha et al. 2021 (src/untangle).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include <quantize/bend/tightness.hpp>
#include <tetmap/cut.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <lattice/grid_motion.hpp>

namespace hexhex::quantization {

/// The plane prescribed for a triangle of the boundary or of a feature, in its tet's chart.
struct BoundaryPlane {
  std::int8_t axis = -1;        ///< 0..2, or -1: the triangle is free
  std::int32_t coordinate = 0;  ///< of its three corners, along the axis

  [[nodiscard]] bool operator==(const BoundaryPlane&) const = default;
};

/// Number of quarter turns of a map around its irregular edges, those where it is not 4 inside or 2
/// on the boundary. Vertices are ascending.
using IrregularEdges = std::map<std::array<Index, 2>, int>;

/// The input of bending: a tet mesh with a seamless map, and the target integers. Half-face 4 * tet
/// + f is the triangle opposite corner f.
struct BendProblem {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  /// Positive seamless parameters, scaled to the target density: the target shapes of tets.
  std::vector<TetParameters> reference;
  /// Per half-face: from the tet's chart to its neighbour's. The rotation is the reference's; the
  /// translation may be any integers that are consistent: around a regular edge, transitions
  /// compose to the identity. Unused on the boundary.
  std::vector<lattice::Transition> transitions;
  std::vector<BoundaryPlane> planes;  ///< per half-face
  /// Further planes for corners on features, by index 4 * tet + corner.
  std::map<std::uint32_t, std::vector<BoundaryPlane>> fixedCorners = {};
  /// Feature edges, which must not be split. Vertices are ascending.
  std::set<std::array<Index, 2>> keptEdges = {};
  /// The irregular edges that the bent map must have.
  IrregularEdges irregularEdges = {};
};

struct BendOptions {
  /// Maximum number of tets after splitting, relative to the input.
  double maxGrowth = 2;
  /// Maximum number of steps that reduce distortion once no tet is flipped.
  int polishing = 60;
};

struct BentMap {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  /// An exact integer-grid map; coordinates are multiples of a power of two. Empty if there are
  /// contradictions.
  std::vector<TetParameters> parameters;
  std::vector<TetParameters> reference;  ///< of the tets after splitting
  std::vector<Index> parentTet;          ///< per tet: the tet of the problem that contains it
  std::vector<tetmap::VertexPair>
      splitEdges;  ///< in order: the first one made vertex points.size() of the problem

  /// Vertices whose planes and transitions contradict each other or do not fix integers.
  std::vector<Index> contradictions;
  /// Nonpositive tets or, if there are none, tets at edges around which the map makes a different
  /// number of turns than required; empty on success.
  std::vector<Index> flippedTets;
  bool isWound = false;  ///< whether they are the latter
  Tightness tightness;   ///< of the flipped tets, if there are any

  double energy = 0;   ///< mean of the foldover-free energy, weighted by volume; 5 if undistorted
  int iterations = 0;  ///< total number of solver steps
  int rounds = 0;      ///< of splitting and untangling

  [[nodiscard]] bool isValid() const noexcept {
    return contradictions.empty() && flippedTets.empty();
  }
};

/// Deterministic for any number of threads.
[[nodiscard]] BentMap bend(BendProblem problem, const BendOptions& options, Stage& stage);

}  // namespace hexhex::quantization
