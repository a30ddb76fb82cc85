// A part of a file that is written from its beginning to its end while other parts are written,
// too.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <io/core/output_file.hpp>

namespace hexhex {

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

}  // namespace hexhex
