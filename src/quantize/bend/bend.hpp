// Bends a seamless map onto integers that have been chosen for it, without flipped tets: the last
// step of quantization.
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

/// The plane that a triangle of the boundary or of a feature is to lie in, in its tet's chart.
struct BoundaryPlane {
  std::int8_t axis = -1;        ///< 0..2, or -1: the triangle is free
  std::int32_t coordinate = 0;  ///< of its three corners along the axis

  [[nodiscard]] bool operator==(const BoundaryPlane&) const = default;
};

/// Quarter turns that a map makes around edges, by their vertices in ascending order, where those
/// are other than 4 inside or 2 on the boundary.
using IrregularEdges = std::map<std::array<Index, 2>, int>;

/// What is to be bent: a tet mesh with a seamless map, and the integers that it shall have.
/// Half-face 4 * tet + f is the triangle opposite corner f.
struct BendProblem {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  /// Positive seamless parameters, times the scale wanted: the shape that each tet should keep.
  std::vector<TetParameters> reference;
  /// Per half-face: from the tet's chart into its neighbour's. The rotation is that of the
  /// reference, the translation may be any integers that are consistent: around a regular edge
  /// transitions compose to the identity. Not used on the boundary.
  std::vector<lattice::Transition> transitions;
  std::vector<BoundaryPlane> planes;  ///< per half-face
  /// Further planes for single corners, by their index 4 * tet + corner: of features.
  std::map<std::uint32_t, std::vector<BoundaryPlane>> fixedCorners = {};
  /// Edges that must not be split, by their vertices in ascending order: of features.
  std::set<std::array<Index, 2>> keptEdges = {};
  /// Those that the bent map is to have.
  IrregularEdges irregularEdges = {};
};

struct BendOptions {
  /// Tets may be split until there are so many times as many.
  double maxGrowth = 2;
  /// Steps that lower distortion, at most, once no tet is flipped.
  int polishing = 60;
};

struct BentMap {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  /// An integer-grid map, exactly: multiples of a power of two. Empty if `contradictions` is not.
  std::vector<TetParameters> parameters;
  std::vector<TetParameters> reference;  ///< of tets as they are now
  std::vector<Index> parentTet;          ///< per tet: that of the problem which it is part of
  std::vector<tetmap::VertexPair>
      splitEdges;  ///< in order: that of vertex points.size() of the problem first

  /// Vertices whose planes and transitions contradict each other, or do not fix integers.
  std::vector<Index> contradictions;
  /// Not positive in the end, or, if all are, around edges that the map winds otherwise than it is
  /// to; empty after success.
  std::vector<Index> flippedTets;
  bool isWound = false;  ///< the latter
  Tightness tightness;   ///< of the flipped tets, if there are any

  double energy = 0;  ///< mean of the foldover-free energy, by volume; 5 where nothing is distorted
  int iterations = 0;  ///< steps of the solver in all
  int rounds = 0;      ///< of splitting and untangling

  [[nodiscard]] bool isValid() const noexcept {
    return contradictions.empty() && flippedTets.empty();
  }
};

/// Deterministic with any number of threads.
[[nodiscard]] BentMap bend(BendProblem problem, const BendOptions& options, Stage& stage);

}  // namespace hexhex::quantization
