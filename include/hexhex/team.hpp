// Processes that make one mesh together, one part each, on one machine or on many. A derived class
// implements their communication; <hexhex/mpi.hpp> provides one for MPI. (docs/user/parts.md)
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// The contributions of all processes, in order of their ranks.
struct GatheredNumbers {
  std::vector<std::uint64_t> numbers;
  std::vector<std::uint64_t> begin;  ///< per process (+1): index of its first number

  [[nodiscard]] std::span<const std::uint64_t> of(std::uint32_t rank) const {
    return std::span(numbers).subspan(begin[rank], begin[rank + 1] - begin[rank]);
  }
};

/// Each process must make all its calls from one thread.
class ProcessTeam {
 public:
  ProcessTeam() = default;
  ProcessTeam(const ProcessTeam&) = delete;
  ProcessTeam& operator=(const ProcessTeam&) = delete;
  virtual ~ProcessTeam() = default;

  [[nodiscard]] virtual std::uint32_t rank() const noexcept = 0;
  [[nodiscard]] virtual std::uint32_t size() const noexcept = 0;

  /// Runs work(); all processes call this together. work() may call the functions below, in the
  /// same order in all processes. If it fails in one process, it fails in all: each throws the
  /// error of the first process that failed, from the next function below that it calls, or at the
  /// end of its work.
  /// @throws Error  whatever work() throws; OutOfMemory for std::bad_alloc, Internal for anything
  ///         else
  void run(const std::function<void()>& work);

  /// Blocks until all processes have reached it.
  void barrier();
  /// Broadcasts bytes of process 0 to all others.
  void share(std::span<std::byte> bytes);
  /// The same for a text of any length. @return the text of process 0
  [[nodiscard]] std::string shareText(const std::string& text);
  /// Checks that a text equals that of process 0.
  /// @param what  name of the text, e.g. "file name"
  /// @throws Error InvalidArgument, in all processes, with both texts
  void requireSame(const std::string& text, const std::string& what);
  [[nodiscard]] GatheredNumbers gather(std::span<const std::uint64_t> mine);
  /// Calls take(rank, numbers) in all processes for the numbers of each process in turn. Use it if
  /// each process needs little of what the others have: it takes memory for the numbers of one
  /// process only.
  void showAll(std::span<const std::uint64_t> mine,
               const std::function<void(std::uint32_t, std::span<const std::uint64_t>)>& take);

 protected:
  // Functions that a team must implement, all called by all processes in the same order. Their
  // exceptions do not propagate to the other processes.

  /// Whether `yes` is true in all processes.
  [[nodiscard]] virtual bool doAllSay(bool yes) = 0;
  /// Broadcasts bytes of one process to all.
  virtual void doShare(std::uint32_t from, std::span<std::byte> bytes) = 0;
  /// Concatenates the numbers of all processes.
  /// @param counts  how many numbers each process contributes
  virtual void doGather(std::span<const std::uint64_t> mine, std::span<const std::uint64_t> counts,
                        std::span<std::uint64_t> all) = 0;

 private:
  void settle(const Error* failure);
  [[nodiscard]] std::vector<std::uint64_t> gatherCounts(std::uint64_t count);
  [[nodiscard]] Error firstError(const Error* failure) noexcept;

  bool running_ = false;
  bool failed_ = false;
};

/// Sends the map of process 0 to all others, which need none: any they have is ignored.
/// @return the map in all other processes; nothing in process 0, which already has it
[[nodiscard]] TetMap shareMap(ProcessTeam& team, const TetMapView& map);

/// Extracts one of as many parts as there are processes: the one with the number of this process's
/// rank. All processes have the same map and options, but each a RepairedMap of its own if maps are
/// to be repaired. Each process holds the map, some tens of bytes per tet, and its part. Checks
/// that all parts form one mesh, as PartSummarySink does.
/// @param parts  with a number of parts of 1 or that of processes
/// @throws Error  the same in all processes, as extractParts(); InvalidArgument for another number
///         of parts, and if maps or options differ; VerificationFailed
[[nodiscard]] MeshPart extractPart(ProcessTeam& team, const TetMapView& map,
                                   const ExtractOptions& options, const PartOptions& parts,
                                   Context& context, ExtractStatistics* statistics = nullptr);

/// The same with a sink in each process, whose functions are called by all processes together.
/// @param[out] summary  of all parts, filled if not null
void extractPart(ProcessTeam& team, PartSink& sink, const TetMapView& map,
                 const ExtractOptions& options, const PartOptions& parts, Context& context,
                 ExtractStatistics* statistics = nullptr, PartsSummary* summary = nullptr);

}  // namespace HEXHEX_API_NAMESPACE
