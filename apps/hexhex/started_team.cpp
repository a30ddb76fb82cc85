#include "started_team.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <thread>

#if defined(HEXHEX_MPI_MODULE)
#include <dlfcn.h>
#endif

#include <hexhex/error.hpp>

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

#if defined(HEXHEX_MPI_MODULE)
/// Loads the module from the command's build folder, or from where it is installed.
void* loadModule() {
  std::error_code error;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  std::string problem;
  for (const std::filesystem::path& place : {folder, folder / HEXHEX_MPI_FOLDER}) {
    const std::filesystem::path file = place / HEXHEX_MPI_MODULE;
    if (!std::filesystem::exists(file, error)) continue;
    // RTLD_GLOBAL: plugins of Open MPI need its symbols.
    if (void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL)) return module;
    problem = dlerror();
  }
  refuse("its module for MPI " + (problem.empty() ? std::string("is not installed.")
                                                  : "cannot be loaded: " + problem + '.'));
}
#endif

}  // namespace

bool isInTeam(bool asked) { return asked || startedProcesses() > 1; }

#if defined(HEXHEX_MPI_MODULE)
StartedTeam::StartedTeam() {
  void* const module = loadModule();
  const auto begin = reinterpret_cast<ProcessTeam* (*)()>(dlsym(module, "hexhexBeginMpi"));
  end_ = reinterpret_cast<void (*)()>(dlsym(module, "hexhexEndMpi"));
  if (begin == nullptr || end_ == nullptr) refuse("its module for MPI is of another version.");
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
