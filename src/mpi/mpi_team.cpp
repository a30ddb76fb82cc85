#include <algorithm>
#include <chrono>
#include <climits>
#include <thread>
#include <vector>

#include <hexhex/mpi.hpp>

namespace hexhex {

namespace {

/// MPI counts by int: longer messages are sent in pieces.
constexpr std::size_t kPiece = std::size_t{1} << 30;
static_assert(kPiece <= INT_MAX);

}  // namespace

// MPI errors end all processes, which is MPI's default.
MpiTeam::MpiTeam(MPI_Comm communicator) {
  MPI_Comm_dup(communicator, &communicator_);
  MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_ARE_FATAL);
  int number = 0;
  MPI_Comm_rank(communicator_, &number);
  rank_ = static_cast<std::uint32_t>(number);
  MPI_Comm_size(communicator_, &number);
  size_ = static_cast<std::uint32_t>(number);
}

MpiTeam::~MpiTeam() { MPI_Comm_free(&communicator_); }

/// Waits for slower processes, which may need the cores that MPI's own waiting would keep busy.
bool MpiTeam::doAllSay(bool yes) {
  const int mine = yes ? 1 : 0;
  int all = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(&mine, &all, 1, MPI_INT, MPI_MIN, communicator_, &request);
  constexpr std::chrono::microseconds kLongest{1000};
  std::chrono::microseconds pause{1};
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return all == 1;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, kLongest);
  }
}

void MpiTeam::doShare(std::uint32_t from, std::span<std::byte> bytes) {
  for (std::size_t begin = 0; begin < bytes.size(); begin += kPiece) {
    const std::size_t count = std::min(kPiece, bytes.size() - begin);
    MPI_Bcast(bytes.data() + begin, static_cast<int>(count), MPI_BYTE, static_cast<int>(from),
              communicator_);
  }
}

void MpiTeam::doGather(std::span<const std::uint64_t> mine, std::span<const std::uint64_t> counts,
                       std::span<std::uint64_t> all) {
  if (all.size() > kPiece) {
    // Beyond MPI's counts: one process after another.
    for (std::uint32_t r = 0; r < size_; ++r) {
      const std::span<std::uint64_t> part = all.first(counts[r]);
      if (r == rank_) std::copy(mine.begin(), mine.end(), part.begin());
      doShare(r, std::as_writable_bytes(part));
      all = all.subspan(counts[r]);
    }
    return;
  }
  std::vector<int> sizes(counts.begin(), counts.end());
  std::vector<int> begin(counts.size(), 0);
  for (std::size_t r = 1; r < counts.size(); ++r) begin[r] = begin[r - 1] + sizes[r - 1];
  MPI_Allgatherv(mine.data(), static_cast<int>(mine.size()), MPI_UINT64_T, all.data(), sizes.data(),
                 begin.data(), MPI_UINT64_T, communicator_);
}

}  // namespace hexhex
