#include <curved/arc_pieces.hpp>

namespace hexhex {

namespace {

std::size_t largerRoom(std::size_t size) { return std::max<std::size_t>(64, 2 * size); }

}  // namespace

void ArcPieces::growArcs() {
  arcRoom_ = largerRoom(arcs_);
  ends_.resize(arcRoom_);
  pointBegin_.resize(arcRoom_);
}

void ArcPieces::growPoints() {
  pointRoom_ = largerRoom(points_);
  position_.resize(pointRoom_);
  parameters_.resize(pointRoom_);
  generatorTet_.resize(pointRoom_);
  generatorCorners_.resize(pointRoom_);
}

void ArcPieces::growSegments() {
  segmentRoom_ = largerRoom(segments_);
  segmentTet_.resize(segmentRoom_);
  segmentCorners_.resize(segmentRoom_);
}

}  // namespace hexhex
