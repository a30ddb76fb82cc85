#include "started_team.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <thread>

#include <hexhex/error.hpp>

#include <base/loaded_library.hpp>

namespace hexhex::command {
namespace {

/// The value of the first of these variables that is set, at least 1; otherwise 1.
int environmentNumber(std::initializer_list<const char*> names) {
  for (const char* const variable : names) {
    if (const char* const text = std::getenv(variable)) return std::max(std::atoi(text), 1);
  }
  return 1;
}

/// Variables of Open MPI; and of MPICH, its derivatives, and Slurm.
int startedProcesses() { return environmentNumber({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}); }

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(ErrorCode::InvalidArgument,
              "hexhex was started by mpirun, or with --mpi, but " + problem +
                  " Start it without mpirun; --parts writes the same files.");
}

}  // namespace

bool isInTeam(bool asked) { return asked || startedProcesses() > 1; }

#if defined(HEXHEX_MPI_MODULE)
StartedTeam::StartedTeam() {
  std::error_code error;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  // In the command's build folder, or where it is installed. Plugins of Open MPI need its symbols.
  LoadedLibrary module({folder / HEXHEX_MPI_MODULE, folder / HEXHEX_MPI_FOLDER / HEXHEX_MPI_MODULE},
                       /*variable=*/nullptr, /*isGlobal=*/true);
  const auto begin = module.find<ProcessTeam* (*)()>("hexhexBeginMpi");
  end_ = module.find<void (*)()>("hexhexEndMpi");
  if (!module.problem().empty()) {
    refuse("its module for MPI cannot be loaded: " + module.problem() + '.');
  }
  team_ = begin();
  const int started = startedProcesses();
  if (started > 1 && team_->size() == 1) {
    end_();
    refuse("its MPI is not that of mpirun: it sees one process and not " + std::to_string(started) +
           '.');
  }
}
StartedTeam::~StartedTeam() { end_(); }
#else
StartedTeam::StartedTeam() { refuse("this build has no support for MPI."); }
StartedTeam::~StartedTeam() = default;
#endif

int threadsInTeam() {
  const int here = environmentNumber({"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"});
  return std::max(static_cast<int>(std::thread::hardware_concurrency()) / here, 1);
}

}  // namespace hexhex::command
