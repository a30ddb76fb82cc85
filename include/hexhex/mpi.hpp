// Meshes in parts on MPI, a part in each process; of the component hexhex::mpi, a library of its
// own. MPI has to be initialized, with MPI_THREAD_FUNNELED at least. (docs/parts.md)
#pragma once

#include <filesystem>
#include <mpi.h>

#include <hexhex/team.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// The processes of a communicator. What it sends does not mix with what others send there.
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

/// extractPart() of a team, for the map of process 0, which all processes get. Others need none.
[[nodiscard]] MeshPart extractPart(MPI_Comm communicator, const TetMapView& map,
                                   const ExtractOptions& options, const PartOptions& parts,
                                   Context& context, ExtractStatistics* statistics = nullptr);

/// The same from a file, which process 0 reads.
/// @throws Error  as readMap(), too
[[nodiscard]] MeshPart extractPart(MPI_Comm communicator, const std::filesystem::path& map,
                                   const ExtractOptions& options, const PartOptions& parts,
                                   Context& context, ExtractStatistics* statistics = nullptr);

}  // namespace HEXHEX_API_NAMESPACE
