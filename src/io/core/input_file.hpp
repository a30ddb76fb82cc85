// Files that are read: as a whole into memory, which is the fastest way to parse them, or in parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>

namespace hexhex::io {

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
/// @param first  what the file begins with, white space aside: one of these characters
/// @throws Error FileNotFound if it does not exist, is a folder, or cannot be read to its end;
///         FileSyntax, before the rest is read, if it is larger than 64 KiB and begins otherwise
///         (for a smaller one, the parser reports more)
[[nodiscard]] Array<char> readWholeFile(const std::filesystem::path& file, Stage& stage,
                                        std::string_view first = {});

/// The same bytes as text.
[[nodiscard]] inline std::string_view asText(const Array<char>& bytes) noexcept {
  return {bytes.data(), bytes.size()};
}

/// A text without the mark that some editors, mostly of Windows, put in front of UTF-8. No binary
/// format begins with it.
[[nodiscard]] constexpr std::string_view withoutByteOrderMark(std::string_view text) noexcept {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

/// What is read: a file, or bytes in memory.
class Input {
 public:
  Input(const std::filesystem::path& file) : name_(file.string()), path_(file) {}
  /// @param bytes  outlive this
  /// @param name  for error messages
  Input(std::string_view bytes, std::string name) : name_(std::move(name)), bytes_(bytes) {}
  /// Of a compressed file.
  /// @param bytes  what it holds
  Input(const std::filesystem::path& file, Array<char> bytes)
      : name_(file.string()),
        path_(file),
        unpacked_(std::make_shared<const Array<char>>(std::move(bytes))),
        bytes_(asText(*unpacked_)) {}

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// Empty for bytes in memory.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] const std::optional<std::string_view>& bytes() const noexcept { return bytes_; }
  /// What readers of this input count.
  [[nodiscard]] const std::shared_ptr<CellCounts>& counts() const noexcept { return counts_; }
  /// All bytes except a byte-order mark. A file is read into `room`; `first` is as in
  /// readWholeFile().
  [[nodiscard]] std::string_view text(Array<char>& room, Stage& stage,
                                      std::string_view first) const {
    if (bytes_) return withoutByteOrderMark(*bytes_);
    room = readWholeFile(path_, stage, first);
    return withoutByteOrderMark(asText(room));
  }

 private:
  std::string name_;
  std::filesystem::path path_;
  std::shared_ptr<const Array<char>> unpacked_;
  std::optional<std::string_view> bytes_;
  std::shared_ptr<CellCounts> counts_ = std::make_shared<CellCounts>();
};

/// Whether a file's name ends in ".gz".
[[nodiscard]] bool isGzip(const std::filesystem::path& file);
/// A file as its readers get it: one whose name ends in ".gz" is unpacked first.
/// @throws Error FileNotFound, and as inflateGzip()
[[nodiscard]] Input openInput(const std::filesystem::path& file, Context& context);

/// What work(stage) returns, with the context's threads.
template <class Work>
[[nodiscard]] auto inStage(Context& context, std::string_view name, const Work& work) {
  Stage stage(context, name);
  decltype(work(stage)) result;
  withThreads(context.threads(), [&] { result = work(stage); });
  return result;
}

/// What a reader makes of an input.
/// @tparam Reader  made from a text, a name for error messages and a stage; has read(), and kFirst,
///         what a text begins with (as of readWholeFile()). If it can be made from an open file,
///         too, a regular file is never in memory as a whole
/// @param more  what else the reader's constructor takes
template <class Reader, class... More>
[[nodiscard]] auto readWith(const Input& input, Stage& stage, const More&... more) {
  const auto read = [&](const auto& source) {
    return Reader(source, input.name(), stage, more...).read();
  };
  if constexpr (std::is_constructible_v<Reader, const InputFile&, const std::string&, Stage&,
                                        const More&...>) {
    if (!input.bytes()) {
      const InputFile file(input.path());
      if (file.isRegular()) return read(file);
    }
  }
  Array<char> room;
  return read(input.text(room, stage, Reader::kFirst));
}

}  // namespace hexhex::io
