// Processes that make one mesh together, on one machine or on many: each makes a part. How they
// reach each other is left to a derived class; <hexhex/mpi.hpp> has one over MPI. (docs/parts.md)
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

/// What all processes give, in order of their ranks.
struct GatheredNumbers {
  std::vector<std::uint64_t> numbers;
  std::vector<std::uint64_t> begin;  ///< per process (+1): its first number

  [[nodiscard]] std::span<const std::uint64_t> of(std::uint32_t rank) const {
    return std::span(numbers).subspan(begin[rank], begin[rank + 1] - begin[rank]);
  }
};

/// All calls of one process come from one thread.
class ProcessTeam {
 public:
  ProcessTeam() = default;
  ProcessTeam(const ProcessTeam&) = delete;
  ProcessTeam& operator=(const ProcessTeam&) = delete;
  virtual ~ProcessTeam() = default;

  [[nodiscard]] virtual std::uint32_t rank() const noexcept = 0;
  [[nodiscard]] virtual std::uint32_t size() const noexcept = 0;

  /// Runs work(), which all processes call together. It may call the functions below, all processes
  /// in the same order. Where it fails in one process, it fails in all: each throws the error of
  /// the first that failed, from the function below that it calls next, or when its work is done.
  /// @throws Error  what work() throws; OutOfMemory for std::bad_alloc, Internal for all else
  void run(const std::function<void()>& work);

  /// Returns when all processes are here.
  void barrier();
  /// Gives bytes of process 0 to all others.
  void share(std::span<std::byte> bytes);
  /// The same for a text of any length. @return that of process 0
  [[nodiscard]] std::string shareText(const std::string& text);
  /// Refuses a text that is another one in process 0.
  /// @param what  it is: "file name"
  /// @throws Error InvalidArgument, in all processes, with both texts
  void requireSame(const std::string& text, const std::string& what);
  [[nodiscard]] GatheredNumbers gather(std::span<const std::uint64_t> mine);
  /// Shows all processes what each has, one after the other, by take(rank, numbers): where each
  /// needs little of what others have. It takes memory for the numbers of one process.
  void showAll(std::span<const std::uint64_t> mine,
               const std::function<void(std::uint32_t, std::span<const std::uint64_t>)>& take);

 protected:
  // What a team takes, all of it called by all processes in the same order. What these functions
  // throw does not reach the other processes.

  /// Whether all processes say yes.
  [[nodiscard]] virtual bool doAllSay(bool yes) = 0;
  /// Gives bytes of one process to all.
  virtual void doShare(std::uint32_t from, std::span<std::byte> bytes) = 0;
  /// Puts what all give behind one another.
  /// @param counts  of numbers that each process gives
  virtual void doGather(std::span<const std::uint64_t> mine, std::span<const std::uint64_t> counts,
                        std::span<std::uint64_t> all) = 0;

 private:
  void settle(const Error* failure);
  [[nodiscard]] std::vector<std::uint64_t> gatherCounts(std::uint64_t count);
  [[nodiscard]] Error firstError(const Error* failure) noexcept;

  bool running_ = false;
  bool failed_ = false;
};

/// Gives the map of process 0 to all others. It counts alone: others need none.
/// @return in other processes, the map; in process 0, which has it, nothing
[[nodiscard]] TetMap shareMap(ProcessTeam& team, const TetMapView& map);

/// Extracts the part of this process, its rank's, of as many parts as there are processes. All
/// processes have the same map and options. What a process holds is the map, some tens of bytes per
/// tet, and its part. That all parts make up one mesh is checked as PartSurvey does.
/// @param parts  whose number of parts is 1, or that of processes
/// @throws Error  in all processes the same, as extractParts(); InvalidArgument for another number
///                of parts, and if maps or options differ; VerificationFailed
[[nodiscard]] MeshPart extractPart(ProcessTeam& team, const TetMapView& map,
                                   const ExtractOptions& options, const PartOptions& parts,
                                   Context& context, ExtractStatistics* statistics = nullptr);

/// The same into a sink of each process, whose calls come in all processes together.
/// @param[out] summary  of all parts, filled if not null
void extractPart(ProcessTeam& team, PartSink& sink, const TetMapView& map,
                 const ExtractOptions& options, const PartOptions& parts, Context& context,
                 ExtractStatistics* statistics = nullptr, PartsSummary* summary = nullptr);

}  // namespace HEXHEX_API_NAMESPACE
