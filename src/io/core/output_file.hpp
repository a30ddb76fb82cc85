// Numbers as text and bytes, and files that appear complete or not at all.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include <hexhex/types.hpp>

#include <io/core/bytes.hpp>

namespace hexhex::io {

/// Room for any number: the longest, -1.2345678901234567e-308, has 24 characters.
inline constexpr std::size_t kNumberRoom = 24;

// Each puts text at a place that has room for it, and returns the place behind.
[[nodiscard]] inline char* put(char* place, char character) {
  *place = character;
  return place + 1;
}
[[nodiscard]] inline char* put(char* place, std::string_view text) {
  return std::copy(text.begin(), text.end(), place);
}
/// With the fewest digits (at most 17) that read back to the same value.
[[nodiscard]] inline char* put(char* place, double number) {
  // Whole numbers, a fifth to a third of those of real maps, take a fifth of the time as integers;
  // without this, writing a map as text takes 15 % longer.
  // Of up to five digits, none has a shorter form with an exponent; 0 may be negative.
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
/// Numbers with a space between them.
template <class Number, std::size_t n>
[[nodiscard]] char* putNumbers(char* place, const std::array<Number, n>& numbers) {
  place = put(place, numbers[0]);
  for (std::size_t i = 1; i < n; ++i) {
    *place++ = ' ';
    place = put(place, numbers[i]);
  }
  return place;
}

/// Puts the bytes of a number, least first, and returns the place behind.
template <class T>
[[nodiscard]] char* putBytes(char* place, T number) {
  const auto bytes = littleBytes(number);
  return std::copy(bytes.begin(), bytes.end(), place);
}

/// Puts the bytes of a number, the largest first, and returns the place behind.
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
/// @param error   the system's number of the reason, or 0
[[noreturn]] void failToWrite(const std::filesystem::path& target, const std::string& reason,
                              int error = 0);

/// A name in the folder of a target that this process has not used yet; one of another process or
/// machine may be there already.
[[nodiscard]] std::filesystem::path temporaryBeside(const std::filesystem::path& target);

/// What a target is in the end if it is a link: renaming onto a link would replace the link.
[[nodiscard]] std::filesystem::path realTarget(const std::filesystem::path& target);

/// The folder of a target, opened before the target is renamed: afterwards nothing but sync() can
/// fail. What functions of this header throw is Error FileWrite.
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

/// Renames a finished file within its folder, durably: the new name survives a power failure.
/// @throws Error FileWrite
void replaceFile(const std::filesystem::path& finished, const std::filesystem::path& target);

/// A buffered file that is written to a temporary beside its target and, when it is safe on the
/// disk, renamed by commit(). Without commit() the temporary vanishes and the target stays as it
/// was. A target that exists and is no regular file (a device, a pipe) is written directly.
///
/// Every function throws Error FileWrite, with the target and the system's reason, if it fails.
class OutputFile {
 public:
  /// What the target may be. Libraries, which write at any position, need a regular file.
  enum class Target { Any, Regular };

  explicit OutputFile(std::filesystem::path target, Target kind = Target::Any);
  /// The temporary of another process, which gives it its name when this one is done with it; until
  /// then it vanishes with any of them.
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
  // Without it a string literal would convert to a number.
  OutputFile& write(const char* text) { return write(std::string_view(text)); }
  /// As put() spells it.
  template <class Number>
  requires std::is_arithmetic_v<Number> OutputFile& write(Number number) {
    makeRoom(kNumberRoom);
    used_ = static_cast<std::size_t>(put(buffer_.get() + used_, number) - buffer_.get());
    return *this;
  }

  /// Writes memory as it is.
  void writeBytes(const void* bytes, std::size_t size);

  /// Whether the target can be written at any position: not if it is a device or a pipe.
  [[nodiscard]] bool hasPositions() const noexcept { return !temporary_.empty(); }
  /// @param why  it has to be one where all positions can be written, e.g. "to which no compressed
  ///             .vtu file can be written"
  void requirePositions(const std::string& why) const;
  /// Writes memory at a position, whatever is written elsewhere in whatever order; only if
  /// hasPositions(). The buffered functions above go on where they were. Thread-safe.
  void writeBytesAt(std::uint64_t position, const void* bytes, std::size_t size) const;
  /// Reads back what was written there; only if hasPositions().
  void readBytesAt(std::uint64_t position, void* bytes, std::size_t size) const;

  /// Where the buffered functions write next.
  [[nodiscard]] std::uint64_t position() const noexcept { return written_ + used_; }
  /// Writes what is buffered; afterwards, writeBytesAt() may replace it.
  void flush();

  /// Writes what is buffered, and lets go of the descriptor and the buffer until resume(), for
  /// those who have more files than the system allows to be open. Only if hasPositions(); nothing
  /// but resume() may follow.
  void suspend();
  void resume();

  /// Writes what is buffered, closes the file, and gives it its name.
  void commit();
  /// The same without a name: for another process's temporary, which stays.
  void handOver();
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }
  /// Empty if the target is written directly.
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// Whether commit() gave a temporary its name, also if its folder could not be synced then.
  [[nodiscard]] bool isNamed() const noexcept { return descriptor_ < 0 && temporary_.empty(); }

  /// As failToWrite().
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
  std::uint64_t written_ = 0;  ///< bytes of earlier buffers
};

/// Writes the bytes of a number, least first.
template <class T>
void writeBytesOf(OutputFile& output, T number) {
  const auto bytes = littleBytes(number);
  output.writeBytes(bytes.data(), bytes.size());
}

/// Buffers what goes to consecutive places of a file.
class FilePart {
 public:
  /// @param file  outlives this; has positions
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

  /// Writes what is buffered. Without it, it is lost.
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

}  // namespace hexhex::io
