// Teams of processes started by mpirun.
#pragma once

#include <hexhex/team.hpp>

namespace hexhex::command {

/// Whether this is one of several MPI processes, or was asked to join a team.
[[nodiscard]] bool isInTeam(bool asked);

/// Joins the team. At most one may exist at a time.
class StartedTeam {
 public:
  /// @throws Error InvalidArgument if MPI cannot be loaded, or is not that of mpirun
  StartedTeam();
  ~StartedTeam();
  StartedTeam(const StartedTeam&) = delete;
  StartedTeam& operator=(const StartedTeam&) = delete;

  [[nodiscard]] ProcessTeam& team() const noexcept { return *team_; }

 private:
  ProcessTeam* team_ = nullptr;
  void (*end_)() = nullptr;
};

/// A default number of threads that leaves cores to the other processes on this machine.
[[nodiscard]] int threadsInTeam();

}  // namespace hexhex::command
