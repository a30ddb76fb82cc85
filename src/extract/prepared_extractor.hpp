// What an extractor keeps: a prepared map at scale 1, and a working copy of its parameters at the
// scale of the last call.
#pragma once

#include <cassert>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/extractor.hpp>

#include <extract/mesh_tags.hpp>
#include <extract/steps.hpp>
#include <igm/measures.hpp>

namespace hexhex {

class Extractor::Prepared {
 public:
  Prepared(const TetMapView& map, const ExtractorOptions& options, Context& context)
      : source_(map), maxScale_(options.maxScale) {
    extraction::runExtraction({"Extractor"}, {}, context, &known_, [&](ExtractStatistics& filled) {
      ExtractOptions prepare;
      prepare.tolerance = options.tolerance;
      prepare.repair = options.repair;
      prepare.round = options.round;
      auto valid = extraction::prepareValid(map, options.maxScale, prepare, context, filled);
      map_ = std::move(valid.prepared);
      source_ = valid.source;
      owner_ = std::move(valid.owner);
      volume_ = igm::parametricVolume(map_.exact);
    });
  }

  /// Scales the map, and runs work(number of cells, statistics).
  template <class Work>
  void run(const extraction::ReportedCall& call, const ExtractOptions& options,
           const extraction::ScaleLimits& limits, Context& context, ExtractStatistics* statistics,
           const Work& work) {
    if (options.scale < 1 || options.scale > maxScale_ / limits.furtherScale) {
      const bool curved = limits.furtherScale > 1;
      throw Error(ErrorCode::InvalidArgument,
                  "The scale is " + std::to_string(options.scale) +
                      (curved ? " for cells of order " + std::to_string(limits.furtherScale) : "") +
                      ". Choose it from 1" + (curved ? ", and its product with the order up" : "") +
                      " to " + std::to_string(maxScale_) + ", which the extractor was made for.");
    }
    extraction::runExtraction(call, known_, context, statistics, [&](ExtractStatistics& filled) {
      const std::uint64_t cells = igm::scaledCells(volume_, options.scale, limits.cells);
      setScale(options.scale, context);
      work(cells, filled);
    });
  }

  /// The mesh of the scaled map, with its tags.
  [[nodiscard]] HexMesh mesh(std::uint64_t cells, const ExtractOptions& options, Context& context,
                             ExtractStatistics& statistics,
                             sweep::SweepObserver* observer = nullptr) {
    HexMesh result = extraction::runEngine(map_, cells, options, context, statistics, observer);
    extraction::carryTags(source_, map_, result, context);
    return result;
  }

  /// Must not be scaled; stages may add to its topology.
  [[nodiscard]] igm::PreparedMap& map() noexcept { return map_; }
  /// May be scaled further: the next call starts from the unscaled map again.
  [[nodiscard]] igm::PreparedMap& mapToScale() {
    keepUnscaled();
    scale_ = 0;
    return map_;
  }

  [[nodiscard]] std::uint64_t volume() const noexcept { return volume_; }

 private:
  /// Copies what scaling changes, before the first scaling.
  void keepUnscaled() {
    if (!unscaledCorners_.empty()) return;
    Array<lattice::Transition> transitions = map_.exact.transitions.table;
    unscaledCorners_ = map_.exact.corners;
    unscaledTransitions_ = std::move(transitions);
  }

  /// Leaves the parameters in map_ scaled. Those at scale 1 are kept as a copy rather than obtained
  /// by division, so that a cancelled call leaves nothing half-scaled behind.
  void setScale(int scale, Context& context) {
    if (scale == scale_) return;
    Stage stage(context, "scaling");
    keepUnscaled();
    assert(scale >= 1 && unscaledCorners_.size() == map_.exact.corners.size());
    scale_ = 0;  // no valid scale until all is done
    map_.exact.transitions.table = unscaledTransitions_;
    constexpr std::size_t kGrain = 4096;
    parallelFor(stage, unscaledCorners_.size(), kGrain,
                [&](std::size_t t) { map_.exact.corners[t] = unscaledCorners_[t]; });
    map_.exact.scale = 1;
    igm::scaleMap(map_.exact, scale, stage);
    scale_ = scale;
  }

  TetMapView source_;                    ///< the caller's map, or what a repair made of it
  std::shared_ptr<const TetMap> owner_;  ///< of the source, unless it is the caller's alone
  int maxScale_;
  ExtractStatistics known_;
  std::uint64_t volume_ = 0;
  igm::PreparedMap map_;
  int scale_ = 1;  ///< of map_
  Array<lattice::LatticeTet> unscaledCorners_;
  Array<lattice::Transition> unscaledTransitions_;
};

}  // namespace hexhex
