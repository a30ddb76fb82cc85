// Safeguards and fast paths that can be turned off: by tests, to show that a safeguard is needed,
// and by ablations (bench/ablation), to measure what a fast path gains. The library itself always
// uses the defaults.
#pragma once

namespace hexhex {

/// Read per stage or per tet, never in an inner loop.
struct EngineSwitches {
  // Safeguards of the atlas engine: results are wrong without them.
  bool resolveOverlaps = true;
  bool markCuts = true;
  bool wideIds = false;  ///< number vertices with 64 bits even if 32 would do (streaming)

  // Speed only: results are the same without.
  bool lookAcrossCuts = true;   ///< before tracing corners behind cuts (atlas/cell_emitter.hpp)
  bool hugePages = true;        ///< for large arrays; process-wide, like the next (base/memory.hpp)
  bool pagePool = true;         ///< smaller arrays share huge pages
  bool fewPoints = true;        ///< tets with few points in their boxes (lattice/few_points.hpp)
  bool unfoldCharts = true;     ///< before everything else (igm/unfold_charts.hpp)
  bool regularVertices = true;  ///< found without their stars (igm/regular_vertices.hpp)
  bool flatStars = true;        ///< recognized among irregular ones (igm/irregular_vertices.hpp)
};

}  // namespace hexhex
