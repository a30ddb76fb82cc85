// A prepared map at scale 1, and a working copy of its parameters at the scale of the last call.
#include <string>
#include <utility>

#include <atlas/atlas.hpp>

#include <hexhex/extractor.hpp>

#include <extract/features.hpp>
#include <extract/steps.hpp>
#include <map/measures.hpp>

namespace hexhex {

class Extractor::Prepared {
 public:
  Prepared(const TetMapView& map, const ExtractorOptions& options, Context& context)
      : given_(map), maxScale_(options.maxScale) {
    runExtraction({}, context, &known_, [&](ExtractStatistics& filled) {
      map_ = prepareValid(map, options.tolerance, options.maxScale, {}, context, filled);
      volume_ = parametricVolume(map_.exact);
    });
  }

  template <class Work>
  void run(const ExtractOptions& options, double cellLimit, Context& context,
           ExtractStatistics* statistics, const Work& work) {
    checkOptions(options);
    if (options.scale < 1 || options.scale > maxScale_) {
      throw Error(ErrorCode::InvalidArgument,
                  "The scale is " + std::to_string(options.scale) + ". Choose it from 1 to " +
                      std::to_string(maxScale_) + ", which the extractor was made for.");
    }
    runExtraction(known_, context, statistics, [&](ExtractStatistics& filled) {
      const std::uint64_t cells = scaledCells(volume_, options.scale, cellLimit);
      setScale(options.scale, context);
      work(map_, cells, filled);
    });
  }

  [[nodiscard]] const TetMapView& given() const noexcept { return given_; }
  [[nodiscard]] std::uint64_t volume() const noexcept { return volume_; }

 private:
  /// Leaves the parameters in map_ scaled. What is kept at scale 1 is a copy, and not obtained by
  /// division, so that a cancelled call leaves nothing half-scaled behind.
  void setScale(int scale, Context& context) {
    if (scale == scale_) return;
    Stage stage(context, "scaling");
    if (unscaledCorners_.empty()) {
      unscaledTransitions_ = map_.exact.transitions.table;
      unscaledCorners_ = map_.exact.corners;
    }
    scale_ = 0;  // neither, until all is done
    map_.exact.transitions.table = unscaledTransitions_;
    constexpr std::size_t kGrain = 4096;
    parallelFor(stage, unscaledCorners_.size(), kGrain,
                [&](std::size_t t) { map_.exact.corners[t] = unscaledCorners_[t]; });
    scaleMap(map_.exact, scale, stage);
    scale_ = scale;
  }

  TetMapView given_;
  int maxScale_;
  ExtractStatistics known_;
  std::uint64_t volume_ = 0;
  PreparedMap map_;
  int scale_ = 1;  ///< of map_
  Array<LatticeTet> unscaledCorners_;
  std::vector<Transition> unscaledTransitions_;
};

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
  prepared_->run(options, kMaxCells, context, statistics,
                 [&](PreparedMap& map, std::uint64_t cells, ExtractStatistics& filled) {
                   mesh = runEngine(map, cells, options, context, filled);
                   carryTags(prepared_->given(), map, mesh, context);
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
  prepared_->run(options, kMaxStreamedCells, context, statistics,
                 [&](const PreparedMap& map, std::uint64_t cells, ExtractStatistics& filled) {
                   streamAtlas(map, cells, sink, context, filled);
                 });
}

std::uint64_t Extractor::cellsAtScaleOne() const noexcept { return prepared_->volume(); }

}  // namespace hexhex
