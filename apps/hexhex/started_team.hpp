// Processes that mpirun has started together.
#pragma once

#include <hexhex/team.hpp>

namespace hexhex::command {

/// Whether this is one of several processes of an MPI, or asked to be one.
[[nodiscard]] bool isInTeam(bool asked);

/// Joins the others. There is one at a time.
class StartedTeam {
 public:
  /// @throws Error InvalidArgument where MPI cannot be loaded, or is not the one of mpirun
  StartedTeam();
  ~StartedTeam();
  StartedTeam(const StartedTeam&) = delete;
  StartedTeam& operator=(const StartedTeam&) = delete;

  [[nodiscard]] ProcessTeam& team() const noexcept { return *team_; }

 private:
  ProcessTeam* team_ = nullptr;
  void (*end_)() = nullptr;
};

/// As many threads as leave cores to other processes on this machine.
[[nodiscard]] int threadsInTeam();

}  // namespace hexhex::command
