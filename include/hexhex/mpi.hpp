// Meshes in parts over MPI, one part per process. Belongs to a separate library, the component
// hexhex::mpi. MPI must be initialized with at least MPI_THREAD_FUNNELED. (docs/user/parts.md)
#pragma once

#include <filesystem>
#include <mpi.h>

#include <hexhex/team.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// The processes of a communicator. Its messages do not interfere with others on this communicator.
class MpiTeam final : public ProcessTeam {
 public:
  explicit MpiTeam(MPI_Comm communicator);
  ~MpiTeam() override;

  [[nodiscard]] std::uint32_t rank() const noexcept override { return rank_; }
  [[nodiscard]] std::uint32_t size() const noexcept override { return size_; }

 protected:
  [[nodiscard]] bool doAllSay(bool yes) override;
  void doShare(std::uint32_t from, std::span<std::byte> bytes) override;
  void doGather(std::span<const std::uint64_t> mine, std::span<const std::uint64_t> counts,
                std::span<std::uint64_t> all) override;

 private:
  MPI_Comm communicator_ = MPI_COMM_NULL;  ///< a duplicate
  std::uint32_t rank_ = 0;
  std::uint32_t size_ = 1;
};

/// extractPart() for a team, with the map of process 0, which is sent to all processes. The others
/// need no map.
[[nodiscard]] MeshPart extractPart(MPI_Comm communicator, const TetMapView& map,
                                   const ExtractOptions& options, const PartOptions& parts,
                                   Context& context, ExtractStatistics* statistics = nullptr);

/// The same with a map from a file, which process 0 reads.
/// @throws Error  also as readMap()
[[nodiscard]] MeshPart extractPart(MPI_Comm communicator, const std::filesystem::path& map,
                                   const ExtractOptions& options, const PartOptions& parts,
                                   Context& context, ExtractStatistics* statistics = nullptr);

}  // namespace HEXHEX_API_NAMESPACE
