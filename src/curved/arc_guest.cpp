#include <algorithm>
#include <utility>

#include <base/output_batches.hpp>
#include <curved/arc_guest.hpp>

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
  for (std::size_t i = 0; i < sizes.batch; ++i) slots_.emplace_back(map_, *vertices_);
  arcCount_ = 0;
  pointCount_ = 0;
  arcs_ = {};
  arcs_.ends.resize(sizes.edges);
  arcs_.pointBegin.resize(sizes.edges + 1);
  keys_.resize(withKeys_ ? sizes.edges : 0);
}

void ArcGuest::add(std::size_t block, const FollowedEdges& edges) {
  Slot& slot = slots_[block % slots_.size()];
  slot.arcCount = edges.edges.size();
  const std::size_t mostPoints = edges.faces.size();  // as EdgeReplay::add() needs
  if (isInOrder()) {
    // In the result itself, as processors write to memory while they compute what comes next.
    const std::uint64_t done = arcCount_ + slot.arcCount;
    requireArcs(done <= arcs_.count());
    lengthenForPieces(arcs_, pointCount_ + mostPoints, done);
    slot.pointCount = slot.replay.add(edges, {arcs_, arcCount_, pointCount_, keys_});
  } else {
    slot.arcs.ends.resize(slot.arcCount);
    slot.arcs.pointBegin.resize(slot.arcCount);
    slot.keys.resize(withKeys_ ? slot.arcCount : 0);
    lengthenForPieces(slot.arcs, mostPoints, slot.arcCount);
    slot.pointCount = slot.replay.add(edges, {slot.arcs, 0, 0, slot.keys});
  }
}

void ArcGuest::measure(std::size_t firstBlock, std::size_t endBlock) {
  for (std::size_t block = firstBlock; block < endBlock; ++block) {
    Slot& slot = slots_[block % slots_.size()];
    slot.firstArc = arcCount_;
    slot.firstPoint = pointCount_;
    arcCount_ += slot.arcCount;
    pointCount_ += slot.pointCount;
  }
  requireArcs(arcCount_ <= arcs_.count());
  if (!isInOrder()) lengthenForPieces(arcs_, pointCount_, arcCount_);
}

void ArcGuest::place(std::size_t block) {
  if (isInOrder()) return;
  const Slot& slot = slots_[block % slots_.size()];
  const ArcColumns to(arcs_, slot.firstArc, slot.firstPoint, keys_);
  const std::size_t arcs = slot.arcCount;
  const std::size_t points = slot.pointCount;
  std::copy_n(slot.arcs.ends.data(), arcs, to.ends);
  std::transform(slot.arcs.pointBegin.data(), slot.arcs.pointBegin.data() + arcs, to.pointBegin,
                 [&](std::uint64_t point) { return point + slot.firstPoint; });
  if (withKeys_) std::copy_n(slot.keys.data(), arcs, to.keys);
  std::copy_n(slot.arcs.points.data(), points, to.points);
  std::copy_n(slot.arcs.parameters.data(), points, to.parameters);
  std::copy_n(slot.arcs.generatorTet.data(), points, to.generatorTet);
  std::copy_n(slot.arcs.generatorCorners.data(), points, to.generatorCorners);
  std::copy_n(slot.arcs.segmentTet.data(), points + arcs, to.segmentTet);
  std::copy_n(slot.arcs.segmentCorners.data(), points + arcs, to.segmentCorners);
}

Arcs ArcGuest::takeArcs() {
  requireArcs(arcCount_ == arcs_.count());
  slots_.clear();
  vertices_.reset();
  lengthenForPieces(arcs_, pointCount_, arcCount_);  // or shortens
  arcs_.pointBegin.back() = pointCount_;
  return std::move(arcs_);
}

}  // namespace hexhex
