#include <algorithm>
#include <utility>

#include <curved/arc_guest.hpp>

#include <base/output_waves.hpp>

namespace hexhex {

namespace {

/// @param fit  whether each edge has come once
void requireArcs(bool fit) {
  if (fit) return;
  throw Error(ErrorCode::Internal,
              "Some hex edges were not followed, or more than once. The map passed all checks, so "
              "this is a bug; please report it with the map.");
}

}  // namespace

void ArcGuest::begin(const LatticeLines& lines, const TraceSizes& sizes, Stage& stage) {
  requireNumbers(sizes.edges);
  slots_.clear();
  vertices_.emplace(map_, lines, sizes.vertices, stage);
  vertexCount_ = sizes.vertices;
  for (std::size_t i = 0; i < sizes.wave; ++i) slots_.emplace_back(map_, *vertices_);
  arcCount_ = 0;
  arcs_ = {};
  arcs_.ends.resize(sizes.edges);
  arcs_.pointBegin.resize(sizes.edges + 1);
  keys_.resize(withKeys_ ? sizes.edges : 0);
}

void ArcGuest::measure(std::size_t firstBlock, std::size_t endBlock) {
  std::uint64_t points = arcs_.points.size();
  for (std::size_t block = firstBlock; block < endBlock; ++block) {
    Slot& slot = slots_[block % slots_.size()];
    slot.firstArc = arcCount_;
    slot.firstPoint = points;
    arcCount_ += slot.replay.arcs();
    points += slot.replay.points();
  }
  requireArcs(arcCount_ <= arcs_.count());
  lengthenForPieces(arcs_, points, arcCount_);
}

void ArcGuest::place(std::size_t block) {
  Slot& slot = slots_[block % slots_.size()];
  slot.replay.copyTo(arcs_, keys_, slot.firstArc, slot.firstPoint);
  slot.replay.clear();
}

Arcs ArcGuest::takeArcs() {
  requireArcs(arcCount_ == arcs_.count());
  slots_.clear();
  vertices_.reset();
  arcs_.pointBegin.back() = arcs_.points.size();
  return std::move(arcs_);
}

}  // namespace hexhex
