// What connects processes that mpirun has started: a library that the command loads then, so that
// it takes MPI at no other time.
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
  MPI_Barrier(MPI_COMM_WORLD);  // what others have to say, they have said
  world.reset();
  MPI_Finalize();
}
}
