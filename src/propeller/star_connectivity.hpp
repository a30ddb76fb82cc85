// Propellers, blades and hex corners of one generator, from the tets around it (Sections 5.3.2 to
// 5.3.4). Needs only signs of face normals and of edge vectors, hence comparisons of integers: no
// determinants.
#pragma once

#include <array>
#include <vector>

#include <adjacency/edge_fan.hpp>

#include <propeller/local_connectivity.hpp>

namespace hexhex::propeller {

/// Extracts one generator after the other; keeps its working memory between them.
class StarConnectivity {
 public:
  /// The structure around a vertex of one generator, before it is appended to the common arrays:
  /// slotBegin counts from the generator's first slot.
  struct Result {
    std::vector<Propeller> propellers;
    std::vector<Slot> slots;
    std::vector<HexCorner> corners;
  };

  StarConnectivity(const igm::PreparedMap& map, const Array<lattice::NormalSigns>& signs)
      : topology_(map.topology), exact_(map.exact), signs_(signs) {}

  /// @param simplex  corners of the generator in `tet`; not a cell
  /// @throws Error Internal if the star is not that of a valid map
  const Result& run(Index tet, lattice::CornerMask simplex);

  /// For each tet of the star: the propeller in each direction.
  struct StarTet {
    Index tet;
    lattice::CornerMask simplex;  ///< the generator's corners in this tet
    std::array<std::uint16_t, lattice::kDirections> propeller;
  };
  [[nodiscard]] const std::vector<StarTet>& star() const noexcept { return star_; }

 private:
  /// A quarter plane at the generator in the chart of a tet: spanned by `first` and `second`.
  struct Quadrant {
    Index tet;
    lattice::Direction first;
    lattice::Direction second;
  };

  void collectStar(Index tet, lattice::CornerMask simplex);
  void findPropellers();
  void announce(std::uint16_t propeller, Index tet, lattice::CornerMask holderSimplex,
                lattice::Direction d);
  void findCasings(std::size_t propeller);
  void findBlades();
  void traceBlade(std::size_t propeller, std::size_t slot);

  [[nodiscard]] StarTet& inStar(Index tet);
  [[nodiscard]] lattice::Direction directionIn(Index tet, std::size_t propeller);
  /// The first quadrant of a propeller that leads into a tet of its holder's star.
  [[nodiscard]] Quadrant anyCasing(std::size_t propeller);
  /// Turns `second` by a right angle around `first`, counter-clockwise or clockwise, from tet to
  /// tet of the holder's star. False if it would leave the mesh.
  [[nodiscard]] bool turn(Quadrant& quadrant, bool counterClockwise);
  /// The quadrant in the chart of the owner of its casing.
  [[nodiscard]] Quadrant canonical(const Quadrant& quadrant);
  [[noreturn]] void fail(const char* what) const;

  const adjacency::TetTopology& topology_;
  const igm::ExactMap& exact_;
  const Array<lattice::NormalSigns>& signs_;
  std::vector<StarTet> star_;
  Result result_;
  /// Per propeller: its holder's owner, corners there, and direction there.
  struct Holder {
    Index tet;
    lattice::CornerMask simplex;
    lattice::Direction direction;
  };
  std::vector<Holder> holders_;
};

/// Calls visit(tet, corners of the simplex there, transition from `tet`'s chart) for every tet
/// around an edge, face or cell, in no particular order.
template <class Visit>
void forEachTetAround(const adjacency::TetTopology& topology, const igm::Transitions& transitions,
                      Index tet, lattice::CornerMask simplex, const Visit& visit) {
  visit(tet, simplex, lattice::Rotation{});
  if (simplex == lattice::kWholeTet) return;
  if (lattice::dimension(simplex) == 2) {
    const adjacency::HalfFace halfFace =
        adjacency::halfFaceOf(tet, lattice::oppositeCorner(simplex));
    const adjacency::HalfFace mate = topology.mate[halfFace];
    if (mate == kNone) return;
    visit(adjacency::tetOf(mate), adjacency::acrossFace(topology, halfFace, simplex),
          transitions.across(halfFace).rotation);
    return;
  }
  adjacency::visitAroundEdge(
      topology, tet, simplex, lattice::Rotation{},
      [&](lattice::Rotation rotation, adjacency::HalfFace out) {
        return transitions.across(out).rotation * rotation;
      },
      [&](const auto& turn, lattice::Rotation rotation) {
        visit(turn.tet(), turn.edge(), rotation);
        return true;
      });
}

}  // namespace hexhex::propeller
