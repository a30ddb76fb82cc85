// What later stages need to know about a map. The preprocessing of Section 5.1 as one chain: from
// the caller's arrays to an exact map.
#pragma once

#include <adjacency/tet_topology.hpp>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <base/switches.hpp>
#include <igm/input.hpp>
#include <igm/sanitization.hpp>
#include <igm/singularities.hpp>

namespace hexhex::igm {

/// Everything that later stages need to know about a map. Refers to the caller's arrays.
struct PreparedMap {
  OrientedMap input;
  adjacency::TetTopology topology;
  Singularities singularities;
  bool isUnfolded = false;       ///< whether `input` has other charts than the caller's
  std::uint64_t chartJumps = 0;  ///< between the caller's charts
  ExactMap exact;                ///< unscaled
};

/// The charts in which a map is prepared.
enum class ChartChoice : std::uint8_t {
  AsGiven,  ///< the caller's
  Unfolded  ///< common ones, if many tets have charts of their own (unfold_charts.hpp)
};

/// Stops when a stage finds defects that the next one cannot handle. The result may be used only if
/// `defects` is empty, except for the parts that earlier stages have finished. Defects are always
/// those of the map in the caller's charts.
/// @param maxScale  the map is going to be scaled by at most this
/// @throws Error InvalidArgument for a tolerance or scale out of range
[[nodiscard]] PreparedMap prepareMap(const TetMapView& map, double tolerance, int maxScale,
                                     Context& context, DefectCollector& defects,
                                     ChartChoice charts = ChartChoice::AsGiven,
                                     const EngineSwitches& switches = {});

}  // namespace hexhex::igm
