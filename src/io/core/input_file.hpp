// Files that are read: as a whole into memory, which is the fastest way to parse them, or in parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// An open file. Every function throws Error FileNotFound, with the file and the system's reason,
/// if it fails.
class InputFile {
 public:
  explicit InputFile(std::filesystem::path file);

  /// Bytes, as of its opening; 0 if it is no regular file.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  [[nodiscard]] bool isRegular() const noexcept { return regular_; }

  /// Reads so many bytes from a position of a regular file. A file that ends before them is an
  /// error. Thread-safe.
  void readAt(std::uint64_t position, void* bytes, std::size_t size) const;

  /// Reads on from where this function or moveTo() stopped: up to `size` bytes.
  /// @return number of bytes, 0 at the end of the file
  [[nodiscard]] std::size_t read(void* bytes, std::size_t size) const;
  void moveTo(std::uint64_t position) const;

 private:
  /// Closed at the end, even of a constructor that fails.
  struct Descriptor {
    explicit Descriptor(int value_) : value(value_) {}
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int value;
  };

  [[noreturn]] void fail(const std::string& reason) const;

  std::filesystem::path path_;
  Descriptor descriptor_;
  bool regular_ = false;
  std::uint64_t size_ = 0;
};

/// The bytes of a file.
/// @throws Error FileNotFound if it does not exist, is a folder, or cannot be read to its end
[[nodiscard]] Array<char> readWholeFile(const std::filesystem::path& file, Stage& stage);

/// The same bytes as text.
[[nodiscard]] inline std::string_view asText(const Array<char>& bytes) noexcept {
  return {bytes.data(), bytes.size()};
}

}  // namespace hexhex
