// extractToFile() is extractTo() into the sink of a file.
#include <memory>

#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>

namespace hexhex {

void extractToFile(const std::filesystem::path& file, const TetMapView& map,
                   const ExtractOptions& options, Context& context, ExtractStatistics* statistics) {
  const std::unique_ptr<MeshSink> sink = openMeshSink(file, context);
  extractTo(*sink, map, options, context, statistics);
}

}  // namespace hexhex
