// Safeguards and special paths that can be turned off: for tests, which show that a safeguard is
// needed, and for ablations (bench/ablation), which show what a special path gains. The library
// itself always works with the defaults.
#pragma once

namespace hexhex {

/// Read per stage or per tet, never in an inner loop.
struct EngineSwitches {
  // Safeguards of the atlas engine: without them, results are wrong.
  bool resolveOverlaps = true;
  bool markCuts = true;
  bool wideIds = false;  ///< numbers vertices with 64 bits even if 32 would do (streaming)

  // Speed alone: the result is the same without.
  bool lookAcrossCuts = true;  ///< before corners behind cuts are traced (atlas/cell_emitter.hpp)
  bool hugePages = true;  ///< for large arrays; of the whole process, as the next (base/memory.hpp)
  bool pagePool = true;   ///< smaller arrays share huge pages
  bool fewPoints = true;  ///< tets with few points in their boxes (lattice/few_points.hpp)
  bool unfoldCharts = true;     ///< before all else (igm/unfold_charts.hpp)
  bool regularVertices = true;  ///< found without their stars (igm/regular_vertices.hpp)
  bool flatStars = true;        ///< told from irregular ones (igm/irregular_vertices.hpp)
};

}  // namespace hexhex
