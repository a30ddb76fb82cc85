// Files that appear complete or not at all.
#pragma once

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace hexhex {

/// A buffered file that is written to a temporary beside its target and renamed by commit().
/// Without commit() the temporary vanishes and the target stays as it was. A target that exists and
/// is no regular file (a device, a pipe) is written directly.
///
/// Every function throws Error FileWrite, with the target and the system's reason, if it fails.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path target);
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
  /// In decimal; a double with the fewest digits (at most 17) that read back to the same value.
  OutputFile& write(double number) { return writeNumber(number); }
  OutputFile& write(std::unsigned_integral auto number) { return writeNumber(number); }

  /// Writes memory as it is.
  void writeBytes(const void* bytes, std::size_t size);

  /// Whether the target can be written at any position: not if it is a device or a pipe.
  [[nodiscard]] bool hasPositions() const noexcept { return !temporary_.empty(); }
  /// Writes memory at a position, whatever is written elsewhere in whatever order; only if
  /// hasPositions(). The buffered functions above go on where they were. Thread-safe.
  void writeBytesAt(std::uint64_t position, const void* bytes, std::size_t size) const;

  /// Where the buffered functions write next.
  [[nodiscard]] std::uint64_t position() const noexcept { return written_ + used_; }
  /// Writes what is buffered; afterwards, writeBytesAt() may replace it.
  void flush();

  /// Writes what is buffered, closes the file, and gives it its name.
  void commit();

  /// What is renamed by commit(); empty if the target is written directly.
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// Throws Error FileWrite.
  /// @param reason  why the file was not written
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  // The longest number, -1.2345678901234567e-308, has 24 characters.
  static constexpr std::size_t kMaxNumberLength = 32;
  // Large enough that system calls cost nothing, small enough for the cache.
  static constexpr std::size_t kBufferSize = std::size_t{1} << 18;

  template <class Number>
  OutputFile& writeNumber(Number number) {
    makeRoom(kMaxNumberLength);
    char* const place = buffer_.get() + used_;
    used_ += static_cast<std::size_t>(std::to_chars(place, place + kMaxNumberLength, number).ptr -
                                      place);
    return *this;
  }
  void makeRoom(std::size_t size) {
    if (used_ + size > kBufferSize) flush();
  }
  void openTemporary();
  void writeThrough(const char* bytes, std::size_t size);
  void discard() noexcept;
  [[noreturn]] void fail(const std::string& what, int error) const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< empty if the target is written directly
  int descriptor_ = -1;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  std::uint64_t written_ = 0;  ///< bytes of earlier buffers
};

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

/// HDF5, and what is built on it, keeps its state in global variables: whoever uses one of these
/// libraries holds this lock.
[[nodiscard]] std::mutex& libraryLock();

/// An OutputFile whose temporary is written by name.
///
/// Functions throw Error FileWrite, with the target and the reason, if they fail. A target that is
/// no regular file is refused: these libraries write at any position.
class LibraryFile {
 public:
  /// Creates the temporary, empty.
  explicit LibraryFile(const std::filesystem::path& target);

  /// What the library is to write; it is closed before commit().
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  void commit() { file_.commit(); }
  [[noreturn]] void fail(const std::string& reason) const { file_.fail(reason); }

 private:
  OutputFile file_;
  std::string name_;
};

}  // namespace hexhex
