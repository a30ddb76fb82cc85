#include <bit>

#include <atlas/corner_resolver.hpp>

namespace hexhex::atlas {

namespace {

std::size_t firstOf(lattice::CellCornerSet corners) {
  return static_cast<std::size_t>(std::countr_zero(corners));
}

}  // namespace

template <class Id>
bool CornerResolver<Id>::resolve(const CellInQuestion& question, Cell& cell,
                                 BrickCache<Id>& cache) {
  const Cell shown = cell;
  const lattice::CellCornerSet open = lookAcross(question, cell, cache);
  if (open != 0) trace(question, open, cell, cache);
  return cell != shown;
}

/// Takes vertices from the other sides of cuts.
/// @return the corners that are still in question, in terms of the tet's own chart
template <class Id>
lattice::CellCornerSet CornerResolver<Id>::lookAcross(const CellInQuestion& question, Cell& cell,
                                                      BrickCache<Id>& cache) {
  const lattice::Rotation toOwn = vertices_.charts().gauge(question.tet).rotation.inverse();
  if (!lookAcrossCuts_) return lattice::turned(toOwn, question.cuts.corners());
  lattice::CellCornerSet open = 0;
  Image image;
  for (lattice::CellCornerSet rest = question.cuts.corners(); rest != 0; rest &= rest - 1) {
    const std::size_t corner = firstOf(rest);
    const CutTransitionId id = question.cuts.transition(corner);
    if (id != image.id) image = imageAcross(id, question.place, cache);
    const std::optional<Id> there = shownBeyond(image, corner, cache);
    const std::size_t own = lattice::turnedCorner(toOwn, corner);
    const bool isHere = Brick<Id>::isVertex(cell[own]);
    const bool isThere = there && Brick<Id>::isVertex(*there);
    const bool isKnown = there && (isHere != isThere || (isHere && cell[own] == *there));
    if (!isKnown) {
      open |= lattice::CellCornerSet{1} << own;
    } else if (isThere) {
      cell[own] = *there;
    }
  }
  return open;
}

template <class Id>
typename CornerResolver<Id>::Image CornerResolver<Id>::imageAcross(CutTransitionId id,
                                                                   const lattice::ChartPoint& place,
                                                                   BrickCache<Id>& cache) {
  if (id == kAnyCuts) return {id, nullptr, {}, {}};
  const CutTransition& map = transitions_[id];
  const lattice::ChartPoint image = map.map.cell(place);
  const CutCells* const cuts = cache.at(map.to, image).cuts;
  if (cuts == nullptr) return {id, nullptr, {}, {}};
  return {id, &map, image, cuts->cells[placeInBrick(image)]};
}

/// What the chart on the other side shows at a corner.
/// @return nothing if the half diagonal may meet further cuts
template <class Id>
std::optional<Id> CornerResolver<Id>::shownBeyond(const Image& image, std::size_t corner,
                                                  BrickCache<Id>& cache) {
  if (image.map == nullptr) return std::nullopt;
  const std::size_t there = lattice::turnedCorner(image.map->map.rotation, corner);
  if (image.cuts.transition(there) != image.map->inverse) return std::nullopt;
  return cache.idAt(image.map->to, lattice::plus(image.place, lattice::kCellCorners[there]));
}

template <class Id>
void CornerResolver<Id>::trace(const CellInQuestion& question, lattice::CellCornerSet corners,
                               Cell& cell, BrickCache<Id>& cache) {
  const lattice::SweptLine& line = *question.centers;
  tracer_.enter(question.tet, line.point(question.index), line.simplex(question.index));
  for (; corners != 0; corners &= corners - 1) {
    const std::size_t corner = firstOf(corners);
    const sweep::CornerPlace place = tracer_.trace(lattice::kCellCorners[corner]);
    cell[corner] = vertices_.vertexAt(place.tet, place.z, cache);
  }
}

template class CornerResolver<std::uint32_t>;
template class CornerResolver<std::uint64_t>;

}  // namespace hexhex::atlas
