// The public class Extractor.
#include <utility>

#include <hexhex/extractor.hpp>

#include <atlas/atlas.hpp>
#include <extract/prepared_extractor.hpp>

namespace hexhex {

Extractor::Extractor(const TetMapView& map, const ExtractorOptions& options, Context& context)
    : prepared_(std::make_unique<Prepared>(map, options, context)) {}

Extractor::Extractor(const TetMapView& map, const ExtractorOptions& options) {
  Context context;
  prepared_ = std::make_unique<Prepared>(map, options, context);
}

Extractor::~Extractor() = default;
Extractor::Extractor(Extractor&& other) noexcept = default;
Extractor& Extractor::operator=(Extractor&& other) noexcept = default;

HexMesh Extractor::extract(const ExtractOptions& options, Context& context,
                           ExtractStatistics* statistics) {
  HexMesh mesh;
  prepared_->run({"Extractor::extract"}, options, {}, context, statistics,
                 [&](std::uint64_t cells, ExtractStatistics& filled) {
                   mesh = prepared_->mesh(cells, options, context, filled);
                 });
  return mesh;
}

HexMesh Extractor::extract(int scale) {
  Context context;
  ExtractOptions options;
  options.scale = scale;
  return extract(options, context);
}

void Extractor::extractTo(MeshSink& sink, const ExtractOptions& options, Context& context,
                          ExtractStatistics* statistics) {
  prepared_->run({"Extractor::extractTo"}, options, {1, extraction::kMaxStreamedCells}, context,
                 statistics, [&](std::uint64_t cells, ExtractStatistics& filled) {
                   atlas::streamAtlas(prepared_->map(), cells, sink, context, filled);
                 });
}

std::uint64_t Extractor::cellsAtScaleOne() const noexcept { return prepared_->volume(); }

}  // namespace hexhex
