// Numbers as text and bytes, and output files that appear complete or not at all.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <base/function_ref.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>

namespace hexhex::io {

/// Room for any number: the longest, -1.2345678901234567e-308, has 24 characters.
inline constexpr std::size_t kNumberRoom = 24;

// Each writes text at `place`, which must have room for it, and returns the end of the text.
[[nodiscard]] inline char* put(char* place, char character) {
  *place = character;
  return place + 1;
}
[[nodiscard]] inline char* put(char* place, std::string_view text) {
  return std::copy(text.begin(), text.end(), place);
}
/// The fewest digits (at most 17) that read back to the same value.
[[nodiscard]] inline char* put(char* place, double number) {
  // A fifth to a third of the numbers in real maps are whole. Formatted as integers they take a
  // fifth of the time; without this, writing a map as text takes 15 % longer. Up to five digits, no
  // number is shorter with an exponent. Zero is excluded, since it may be negative.
  constexpr double kMost = 99999;
  if (number >= -kMost && number <= kMost && number != 0) {
    const auto whole = static_cast<std::int32_t>(number);
    if (static_cast<double>(whole) == number) {
      return std::to_chars(place, place + kNumberRoom, whole).ptr;
    }
  }
  return std::to_chars(place, place + kNumberRoom, number).ptr;
}
[[nodiscard]] inline char* put(char* place, std::int32_t number) {
  return std::to_chars(place, place + kNumberRoom, number).ptr;
}
[[nodiscard]] inline char* put(char* place, std::unsigned_integral auto number) {
  return std::to_chars(place, place + kNumberRoom, number).ptr;
}
/// Numbers separated by spaces.
template <class Number, std::size_t n>
[[nodiscard]] char* putNumbers(char* place, const std::array<Number, n>& numbers) {
  place = put(place, numbers[0]);
  for (std::size_t i = 1; i < n; ++i) {
    *place++ = ' ';
    place = put(place, numbers[i]);
  }
  return place;
}

/// Writes the little-endian bytes of a number and returns their end.
template <class T>
[[nodiscard]] char* putBytes(char* place, T number) {
  const auto bytes = littleBytes(number);
  return std::copy(bytes.begin(), bytes.end(), place);
}

/// Writes the big-endian bytes of a number and returns their end.
template <class T>
[[nodiscard]] char* putBigBytes(char* place, T number) {
  const auto bytes = littleBytes(number);
  return std::reverse_copy(bytes.begin(), bytes.end(), place);
}

/// putBytes() of three coordinates.
[[nodiscard]] inline char* putBytes(char* place, const Vec3& point) {
  for (const double coordinate : point) place = putBytes(place, coordinate);
  return place;
}

/// Throws Error FileWrite.
/// @param reason  why the target was not written
/// @param error   errno, or 0
[[noreturn]] void failToWrite(const std::filesystem::path& target, const std::string& reason,
                              int error = 0);

/// A path in the target's folder that this process has not used yet; a file of another process or
/// machine may exist there.
[[nodiscard]] std::filesystem::path temporaryBeside(const std::filesystem::path& target);

/// The target with symbolic links resolved: renaming onto a link would replace the link.
[[nodiscard]] std::filesystem::path realTarget(const std::filesystem::path& target);

/// The folder of a target, opened before the rename, so that only sync() can fail afterwards. Like
/// the functions above, its members throw Error FileWrite.
class ChangedFolder {
 public:
  explicit ChangedFolder(const std::filesystem::path& target);
  ~ChangedFolder();
  ChangedFolder(const ChangedFolder&) = delete;
  ChangedFolder& operator=(const ChangedFolder&) = delete;

  /// Makes the new name survive a power failure.
  void sync() const;

 private:
  std::filesystem::path target_;
  int descriptor_;
};

/// A buffered file, written to a temporary beside its target. commit() syncs it to disk and renames
/// it; without commit(), the temporary is removed and the target left unchanged. An existing target
/// that is not a regular file (a device, a pipe) is written directly.
///
/// On failure, every function throws Error FileWrite with the target and the system's reason.
class OutputFile {
 public:
  /// Allowed targets. Libraries such as HDF5 write at arbitrary positions and need a regular file.
  enum class Target { Any, Regular };

  explicit OutputFile(std::filesystem::path target, Target kind = Target::Any);
  /// Opens the temporary of another process, which will rename it after this process has called
  /// handOver(); until then either process removes it on failure.
  OutputFile(std::filesystem::path target, std::filesystem::path temporary);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  OutputFile& write(char character) {
    makeRoom(1);
    buffer_[used_++] = character;
    return *this;
  }
  OutputFile& write(std::string_view text) {
    writeBytes(text.data(), text.size());
    return *this;
  }
  // Otherwise a string literal would convert to a number.
  OutputFile& write(const char* text) { return write(std::string_view(text)); }
  /// Writes a number as put() does.
  template <class Number>
  requires std::is_arithmetic_v<Number> OutputFile& write(Number number) {
    makeRoom(kNumberRoom);
    used_ = static_cast<std::size_t>(put(buffer_.get() + used_, number) - buffer_.get());
    return *this;
  }

  /// Writes raw bytes.
  void writeBytes(const void* bytes, std::size_t size);

  /// Whether random access is possible: not for a device or a pipe.
  [[nodiscard]] bool hasPositions() const noexcept { return !temporary_.empty(); }
  /// @param why  clause of the message, e.g. "to which no compressed .vtu file can be written"
  void requirePositions(const std::string& why) const;
  /// Writes bytes at a position, in any order and independently of the buffered functions above.
  /// Thread-safe. @pre  hasPositions()
  void writeBytesAt(std::uint64_t position, const void* bytes, std::size_t size) const;
  /// Reads back bytes. @pre  hasPositions()
  void readBytesAt(std::uint64_t position, void* bytes, std::size_t size) const;

  /// Position of the next buffered write.
  [[nodiscard]] std::uint64_t position() const noexcept { return written_ + used_; }
  /// Writes the buffer to the file; afterwards, writeBytesAt() may overwrite it.
  void flush();

  /// Flushes, and releases the descriptor and the buffer until resume(), for callers with more
  /// files than may be open at once. Only resume() may follow. @pre  hasPositions()
  void suspend();
  void resume();

  /// Flushes, syncs and closes the file, then renames it to its target.
  void commit();
  /// Finishes another process's temporary without renaming it.
  void handOver();
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }
  /// Empty if the target is written directly.
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// Whether commit() has renamed the temporary, even if syncing its folder failed afterwards.
  [[nodiscard]] bool isNamed() const noexcept { return descriptor_ < 0 && temporary_.empty(); }

  /// See failToWrite().
  [[noreturn]] void fail(const std::string& reason, int error = 0) const;

 private:
  // Large enough that system calls cost nothing, small enough for the cache.
  static constexpr std::size_t kBufferSize = std::size_t{1} << 18;

  void makeRoom(std::size_t size) {
    if (used_ + size > kBufferSize) flush();
  }
  void openTemporary();
  void finish(bool sync);
  template <class Write>
  void writeAll(const void* bytes, std::size_t size, const Write& write) const;
  void writeThrough(const void* bytes, std::size_t size);

  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< empty if the target is written directly
  int descriptor_ = -1;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  std::uint64_t written_ = 0;  ///< bytes flushed so far
};

/// Writes the little-endian bytes of a number.
template <class T>
void writeBytesOf(OutputFile& output, T number) {
  const auto bytes = littleBytes(number);
  output.writeBytes(bytes.data(), bytes.size());
}

/// Buffers writes to consecutive positions of a file.
class FilePart {
 public:
  /// @param file  must outlive this; has positions
  FilePart(const OutputFile& file, std::uint64_t position)
      : file_(&file), position_(position), buffer_(new char[kBufferSize]) {}

  void writeBytes(const void* bytes, std::size_t size) {
    if (size > kBufferSize - used_) {
      flush();
      if (size >= kBufferSize) return writeThrough(bytes, size);
    }
    std::copy_n(static_cast<const char*>(bytes), size, buffer_.get() + used_);
    used_ += size;
  }

  /// Writes the buffer to the file; data that is not flushed is lost.
  void flush() {
    writeThrough(buffer_.get(), used_);
    used_ = 0;
  }

 private:
  // Large enough that system calls cost nothing, small enough for eight of them in the cache.
  static constexpr std::size_t kBufferSize = std::size_t{1} << 17;

  void writeThrough(const void* bytes, std::size_t size) {
    file_->writeBytesAt(position_, bytes, size);
    position_ += size;
  }

  const OutputFile* file_;
  std::uint64_t position_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
};

/// Formats runs of lines in parallel and writes them in order, in bounded memory: formatting
/// numbers takes longer than writing them.
class LineWriter {
 public:
  /// @param output   an OutputFile or FilePart
  /// @param threads  as in Context
  template <class Output>
  LineWriter(Output& output, int threads)
      : pass_([&output](std::string_view text) { output.writeBytes(text.data(), text.size()); }),
        quiet_(threads),
        stage_(quiet_, "write lines") {
    const auto count = kBlocksPerThread * static_cast<std::size_t>(effectiveThreads(threads));
    for (std::size_t i = 0; i < count; ++i) blocks_.emplace_back(new char[kBlockBytes]);
    sizes_.resize(count);
  }

  void write(std::string_view text) { pass_(text); }
  /// Writes the text that format(place, i) stores at `place`, a char*, for i in [0, n) in order.
  /// @param room    maximum size of one call's text, at most kBlockBytes
  /// @param format  returns the end of its text; called from several threads
  /// @param progress  advanced by n unless null
  template <class Format>
  void write(std::size_t n, std::size_t room, const Format& format, LoopProgress* progress) {
    assert(room <= kBlockBytes);
    writeBlocks(
        n, kBlockBytes / room,
        [&format](char* place, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) place = format(place, i);
          return place;
        },
        progress);
  }

 private:
  // Fits in the L2 cache, and makes the overhead of starting a block negligible.
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
  // Blocks take different times; with several per thread, no thread waits long for the others.
  static constexpr std::size_t kBlocksPerThread = 8;

  /// @param formatLines  stores the text of [begin, end), and returns its end
  void writeBlocks(std::size_t n, std::size_t grain,
                   FunctionRef<char*(char* place, std::size_t begin, std::size_t end)> formatLines,
                   LoopProgress* progress) {
    const std::size_t round = grain * blocks_.size();
    for (std::size_t first = 0; first < n; first += round) {
      const std::size_t count = std::min(round, n - first);
      withThreadsHere(quiet_.threads(), [&] {
        parallelBlocks(stage_, count, grain,
                       [&](std::size_t begin, std::size_t end, std::size_t block) {
                         char* const place = blocks_[block].get();
                         const char* const after = formatLines(place, first + begin, first + end);
                         sizes_[block] = static_cast<std::size_t>(after - place);
                       });
      });
      for (std::size_t block = 0; block < blockCount(count, grain); ++block) {
        pass_({blocks_[block].get(), sizes_[block]});
      }
      if (progress != nullptr) progress->advance(count);
    }
  }

  std::function<void(std::string_view)> pass_;
  // Rounds are internal: progress is reported across all of them.
  Context quiet_;
  Stage stage_;
  std::vector<std::unique_ptr<char[]>> blocks_;
  std::vector<std::size_t> sizes_;
};

}  // namespace hexhex::io
