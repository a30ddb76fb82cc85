// Meshes of maps, and what their improvement reports.
#pragma once

#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>

namespace hexhex::test {

inline ImproveReport improvedOn(HexMesh& mesh, const TetMap& map,
                                const ImproveOptions& options = {}, int threads = 2) {
  Context context(threads);
  return improve(mesh, map, options, context);
}

inline HexMesh extracted(const TetMap& map, int scale) {
  ExtractOptions options;
  options.scale = scale;
  Context context(2);
  return extract(map, options, context);
}

}  // namespace hexhex::test
