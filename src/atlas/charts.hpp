// The atlas: tets glued into charts.
#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <lattice/gauge.hpp>

namespace hexhex::atlas {

/// Every tet belongs to a chart and has a gauge that takes its own chart there.
struct Charts {
  /// The chart of a tet that no chart could take without overlap: its cells are traced.
  static constexpr Index kNoChart = kNone;

  Array<Index> chart;    ///< per tet
  Array<Index> gaugeOf;  ///< per tet: index in `gauges`
  std::vector<lattice::Gauge> gauges;
  Index count = 0;  ///< charts

  [[nodiscard]] const lattice::Gauge& gauge(Index tet) const noexcept {
    return gauges[gaugeOf[tet]];
  }

  /// Whether the chart continues across a half-face (with a mate): both tets are in one chart,
  /// and both gauges agree on the face.
  [[nodiscard]] bool isGlued(const adjacency::TetTopology& topology,
                             const igm::Transitions& transitions,
                             adjacency::HalfFace halfFace) const noexcept {
    const Index here = adjacency::tetOf(halfFace);
    const Index there = adjacency::tetOf(topology.mate[halfFace]);
    return chart[here] == chart[there] && chart[here] != kNoChart &&
           gaugesAgree(topology, transitions, halfFace);
  }

  /// Whether both gauges agree on a half-face (with a mate), whatever the charts.
  [[nodiscard]] bool gaugesAgree(const adjacency::TetTopology& topology,
                                 const igm::Transitions& transitions,
                                 adjacency::HalfFace halfFace) const noexcept {
    assert(topology.mate[halfFace] != kNone);
    const Index here = adjacency::tetOf(halfFace);
    const Index there = adjacency::tetOf(topology.mate[halfFace]);
    if (!transitions.isNonTrivial(halfFace)) {
      return gaugeOf[here] == gaugeOf[there] || gauge(here) == gauge(there);
    }
    return gauge(there) * transitions.across(halfFace) == gauge(here);
  }
};

/// Builds one chart per connected component. Tets connected by identity transitions share a gauge;
/// these patches are joined along a breadth-first tree.
[[nodiscard]] Charts buildCharts(const igm::PreparedMap& map, Stage& stage);

}  // namespace hexhex::atlas
