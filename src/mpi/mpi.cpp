#include <hexhex/io.hpp>
#include <hexhex/mpi.hpp>

namespace hexhex {

namespace {

/// To be called inside MpiTeam::run().
MeshPart extractShared(MpiTeam& team, const TetMapView& map, const ExtractOptions& options,
                       const PartOptions& parts, Context& context, ExtractStatistics* statistics) {
  const TetMap shared = shareMap(team, map);
  return extractPart(team, team.rank() == 0 ? map : TetMapView(shared), options, parts, context,
                     statistics);
}

}  // namespace

MeshPart extractPart(MPI_Comm communicator, const TetMapView& map, const ExtractOptions& options,
                     const PartOptions& parts, Context& context, ExtractStatistics* statistics) {
  MpiTeam team(communicator);
  MeshPart part;
  team.run([&] { part = extractShared(team, map, options, parts, context, statistics); });
  return part;
}

MeshPart extractPart(MPI_Comm communicator, const std::filesystem::path& map,
                     const ExtractOptions& options, const PartOptions& parts, Context& context,
                     ExtractStatistics* statistics) {
  MpiTeam team(communicator);
  MeshPart part;
  team.run([&] {
    const TetMap read = team.rank() == 0 ? readMap(map, context) : TetMap{};
    part = extractShared(team, read, options, parts, context, statistics);
  });
  return part;
}

}  // namespace hexhex
