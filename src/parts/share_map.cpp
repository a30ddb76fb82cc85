// A map of one process for all of a team.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/team.hpp>

namespace hexhex::parts {

namespace {

/// Process 0 gives copies of pieces: what it shares is what all may write to.
template <class T>
void shareArray(ProcessTeam& team, std::span<const T> mine, std::vector<T>& theirs) {
  std::uint64_t size = mine.size();
  team.share(std::as_writable_bytes(std::span(&size, 1)));
  if (team.rank() > 0) theirs.resize(size);
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::vector<T> piece;
  for (std::size_t first = 0; first < size; first += kPiece) {
    const std::size_t count = std::min<std::size_t>(kPiece, size - first);
    if (team.rank() == 0) {
      const std::span<const T> given = mine.subspan(first, count);
      piece.assign(given.begin(), given.end());
    }
    const std::span<T> items =
        team.rank() == 0 ? std::span(piece) : std::span(theirs).subspan(first, count);
    team.share(std::as_writable_bytes(items));
  }
}

}  // namespace

}  // namespace hexhex::parts

namespace hexhex {

TetMap shareMap(ProcessTeam& team, const TetMapView& map) {
  TetMap shared;
  team.run([&] {
    parts::shareArray(team, map.points, shared.points);
    parts::shareArray(team, map.tets, shared.tets);
    parts::shareArray(team, map.parameters, shared.parameters);
    parts::shareArray(team, map.edgeValences, shared.edgeValences);
    parts::shareArray(team, map.rotations, shared.rotations);
    parts::shareArray(team, map.features.vertices, shared.features.vertices);
    parts::shareArray(team, map.features.edges, shared.features.edges);
    parts::shareArray(team, map.features.faces, shared.features.faces);
    parts::shareArray(team, map.regions, shared.regions);
  });
  return shared;
}

}  // namespace hexhex
