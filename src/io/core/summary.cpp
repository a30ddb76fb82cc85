#include <algorithm>
#include <bit>
#include <mutex>

#include <hexhex/io.hpp>
#include <hexhex/summary.hpp>

#include <base/parallel.hpp>
#include <io/core/checked_sink.hpp>

namespace hexhex::io {
namespace {

constexpr std::size_t kSummaryGrain = std::size_t{1} << 13;  // a fraction of a millisecond of work

/// The contribution of one number of an array to its checksum: a mix of all bits of both
/// (the finalizer of SplitMix64).
std::uint64_t summand(std::uint64_t place, std::uint64_t value) {
  std::uint64_t z = value ^ ((place + 1) * 0x9e3779b97f4a7c15U);  // odd: 2^64 / golden ratio
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

void enlarge(Vec3& lower, Vec3& upper, const Vec3& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis] = std::min(lower[axis], point[axis]);
    upper[axis] = std::max(upper[axis], point[axis]);
  }
}

}  // namespace

/// Accumulates a summary. Sums of integers and bounding boxes do not depend on the order.
class SummaryWriter {
 public:
  explicit SummaryWriter(int threads) : quiet_(threads) {}

  [[nodiscard]] const MeshSummary& result() const noexcept { return result_; }

  void begin(std::uint64_t points, std::uint64_t cells) { result_ = {points, cells, {}, {}, 0, 0}; }

  void points(const PointPiece& piece) {
    if (piece.first == 0) result_.lower = result_.upper = piece.points.front();
    forEachBlock(piece.points.size(), [&](std::size_t begin, std::size_t end) {
      MeshSummary part;
      part.lower = part.upper = piece.points[begin];
      for (std::size_t i = begin; i < end; ++i) {
        enlarge(part.lower, part.upper, piece.points[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          part.pointChecksum += summand(3 * (piece.first + i) + axis,
                                        std::bit_cast<std::uint64_t>(piece.points[i][axis]));
        }
      }
      const std::lock_guard lock(mutex_);
      result_.pointChecksum += part.pointChecksum;
      enlarge(result_.lower, result_.upper, part.lower);
      enlarge(result_.lower, result_.upper, part.upper);
    });
  }

  void beginCells() {}
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells) {
    forEachBlock(cells.size(), [&](std::size_t begin, std::size_t end) {
      std::uint64_t sum = 0;
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t k = 0; k < 8; ++k) sum += summand(8 * (first + i) + k, cells[i][k]);
      }
      const std::lock_guard lock(mutex_);
      result_.cellChecksum += sum;
    });
  }
  void end() {}

 private:
  template <class F>
  void forEachBlock(std::size_t n, const F& f) {
    Stage stage(quiet_, "summary");
    withThreadsHere(quiet_.threads(), [&] {
      parallelBlocks(
          stage, n, kSummaryGrain,
          [&f](std::size_t begin, std::size_t end, std::size_t /*block*/) { f(begin, end); });
    });
  }

  Context quiet_;  // many short loops, which report no progress of their own
  std::mutex mutex_;
  MeshSummary result_;
};

}  // namespace hexhex::io

namespace hexhex {

class SummarySink::Adder final : public io::CheckedSink<io::SummaryWriter> {
  using CheckedSink::CheckedSink;
};

SummarySink::SummarySink(Context& context, MeshSink* next)
    : adder_(std::make_unique<Adder>("summary", "summary", context, context.threads())),
      next_(next) {}
SummarySink::~SummarySink() = default;

void SummarySink::begin(std::uint64_t pointCount, std::uint64_t cellCount) {
  adder_->begin(pointCount, cellCount);
  if (next_ != nullptr) next_->begin(pointCount, cellCount);
}
void SummarySink::points(const PointPiece& piece) {
  adder_->points(piece);
  if (next_ != nullptr) next_->points(piece);
}
void SummarySink::cells(std::uint64_t first, std::span<const Hex> cells) {
  adder_->cells(first, cells);
  if (next_ != nullptr) next_->cells(first, cells);
}
void SummarySink::cells(std::uint64_t first, std::span<const Hex64> cells) {
  adder_->cells(first, cells);
  if (next_ != nullptr) next_->cells(first, cells);
}
void SummarySink::end() {
  adder_->end();
  if (next_ != nullptr) next_->end();
}
const MeshSummary& SummarySink::result() const noexcept { return adder_->writer().result(); }

MeshSummary summarize(const HexMesh& mesh, Context& context) {
  SummarySink sink(context);
  withThreads(context.threads(), [&] { io::sendTo(sink, mesh); });
  return sink.result();
}

MeshSummary summarizeFile(const std::filesystem::path& file, const ReadOptions& options,
                          Context& context) {
  SummarySink sink(context);
  readHexMeshTo(sink, file, options, context);
  return sink.result();
}

MeshSummary summarizeFile(const std::filesystem::path& file, Context& context) {
  return summarizeFile(file, {}, context);
}

}  // namespace hexhex
