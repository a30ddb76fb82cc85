// The module that connects processes started by mpirun. The command loads it only then, so that it
// does not depend on MPI otherwise.
#include <optional>

#include <hexhex/mpi.hpp>

namespace {

std::optional<hexhex::MpiTeam> world;

}  // namespace

extern "C" {

HEXHEX_API hexhex::ProcessTeam* hexhexBeginMpi() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  return &world.emplace(MPI_COMM_WORLD);
}

HEXHEX_API void hexhexEndMpi() {
  MPI_Barrier(MPI_COMM_WORLD);  // lets other processes print their errors first
  world.reset();
  MPI_Finalize();
}
}
