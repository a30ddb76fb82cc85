// A map of one process for all of a team.
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/team.hpp>

namespace hexhex::parts {

namespace {

template <class T>
void shareArray(ProcessTeam& team, std::span<const T> mine, std::vector<T>& theirs) {
  std::uint64_t size = mine.size();
  team.share(std::as_writable_bytes(std::span(&size, 1)));
  if (team.rank() > 0) theirs.resize(size);
  // Process 0 gives, and its bytes stay as they are.
  const std::span<T> items =
      team.rank() > 0 ? std::span(theirs) : std::span(const_cast<T*>(mine.data()), mine.size());
  team.share(std::as_writable_bytes(items));
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
