// Names propellers and blades by directions in the chart of a tet.
#pragma once

#include <igm/prepare.hpp>
#include <propeller/link_corners.hpp>
#include <propeller/local_connectivity.hpp>

namespace hexhex {

class SlotFinder {
 public:
  SlotFinder(const PreparedMap& map, const Array<NormalSigns>& signs, const HexVertices& vertices,
             const LocalConnectivity& local)
      : topology_(map.topology),
        exact_(map.exact),
        signs_(signs),
        vertices_(vertices),
        local_(local) {}

  /// The propeller that leaves a vertex in direction `along`, and its blade in direction `beside`,
  /// where the tet holds the beginning of the quarter plane that they span.
  /// @throws MissingVertex  if there is none
  [[nodiscard]] SlotName find(Index tet, Index generator, Direction along, Direction beside) const;

 private:
  [[nodiscard]] std::size_t findPropeller(Index tet, Index generator, Direction along) const;
  [[nodiscard]] Slot casingKey(Index tet, Index generator, Direction along, Direction beside) const;

  const TetTopology& topology_;
  const ExactMap& exact_;
  const Array<NormalSigns>& signs_;
  const HexVertices& vertices_;
  const LocalConnectivity& local_;
};

}  // namespace hexhex
