// Input files: read as a whole into memory, which is fastest to parse, or in sections.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>

namespace hexhex::io {

/// An open file. On failure, every function throws Error FileNotFound with the file name and the
/// system's reason.
class InputFile {
 public:
  explicit InputFile(std::filesystem::path file);

  /// Size in bytes when the file was opened; 0 unless it is a regular file.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  [[nodiscard]] bool isRegular() const noexcept { return regular_; }

  /// Reads exactly `size` bytes at a position of a regular file; a shorter file is an error.
  /// Thread-safe.
  void readAt(std::uint64_t position, void* bytes, std::size_t size) const;

  /// Reads up to `size` bytes, sequentially or from the position given to moveTo().
  /// @return number of bytes, 0 at the end of the file
  [[nodiscard]] std::size_t read(void* bytes, std::size_t size) const;
  void moveTo(std::uint64_t position) const;

 private:
  /// Closes the descriptor even if the constructor of InputFile throws.
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
/// @param first  characters that the file may begin with, after white space; empty: any
/// @throws Error FileNotFound if it does not exist, is a folder, or cannot be read to its end;
///         FileSyntax, before the rest is read, if it is larger than 64 KiB and begins with another
///         character (smaller files are left to the parser, whose message is more precise)
[[nodiscard]] Array<char> readWholeFile(const std::filesystem::path& file, Stage& stage,
                                        std::string_view first = {});

/// The bytes as text.
[[nodiscard]] inline std::string_view asText(const Array<char>& bytes) noexcept {
  return {bytes.data(), bytes.size()};
}

/// A text without its UTF-8 byte order mark, which some editors write, mostly on Windows. No binary
/// format begins with those bytes.
[[nodiscard]] constexpr std::string_view withoutByteOrderMark(std::string_view text) noexcept {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

/// The source of a reader: a file, or bytes in memory.
class Input {
 public:
  Input(const std::filesystem::path& file) : name_(file.string()), path_(file) {}
  /// @param bytes  must outlive this
  /// @param name   for error messages
  Input(std::string_view bytes, std::string name) : name_(std::move(name)), bytes_(bytes) {}
  /// For a compressed file.
  /// @param bytes  its uncompressed content
  Input(const std::filesystem::path& file, Array<char> bytes)
      : name_(file.string()),
        path_(file),
        unpacked_(std::make_shared<const Array<char>>(std::move(bytes))),
        bytes_(asText(*unpacked_)) {}

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// Empty for bytes in memory.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] const std::optional<std::string_view>& bytes() const noexcept { return bytes_; }
  /// Throws an error: "<name>: <sentence>".
  /// @param sentence  its parts, as for concat()
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    throw Error(code, concat(name_, ": ", sentence...));
  }
  /// The cells that readers of this input have counted.
  [[nodiscard]] const std::shared_ptr<CellCounts>& counts() const noexcept { return counts_; }
  /// Where readers of hex meshes put other cells; null: nowhere.
  [[nodiscard]] OtherCells* others() const noexcept { return others_; }
  void setOthers(OtherCells* others) noexcept { others_ = others; }
  /// All bytes except a byte order mark. A file is read into `room`; for `first` see
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
  OtherCells* others_ = nullptr;
};

/// Whether a file's name ends in ".gz".
[[nodiscard]] bool isGzip(const std::filesystem::path& file);
/// The extension of a file's name in lower case; of "NAME.vtk.gz", that is ".vtk".
[[nodiscard]] std::string contentExtension(const std::filesystem::path& file);
/// Opens a file for its readers; ".gz" files are uncompressed first.
/// @throws Error FileNotFound, and as inflateGzip()
[[nodiscard]] Input openInput(const std::filesystem::path& file, Context& context);

/// Runs work(stage) with the context's threads and returns its result.
template <class Work>
[[nodiscard]] auto inStage(Context& context, std::string_view name, const Work& work) {
  Stage stage(context, name);
  decltype(work(stage)) result;
  withThreads(context.threads(), [&] { result = work(stage); });
  return result;
}

/// Runs a reader on an input and returns its result.
/// @tparam Reader  constructed from a text, a name for error messages and a stage; has read(), and
///         kFirst, the characters that a text may begin with (see readWholeFile()). If it can also
///         be constructed from an InputFile, regular files are not loaded as a whole
/// @param more  further arguments of the reader's constructor
template <class Reader, class... More>
[[nodiscard]] auto readWith(const Input& input, Stage& stage, const More&... more) {
  const auto read = [&](const auto& source) {
    return Reader(source, input.name(), stage, more...).read();
  };
  if constexpr (std::is_constructible_v<Reader, const InputFile&, const std::string&, Stage&,
                                        const More&...>) {
    std::error_code unknown;  // a pipe can be opened only once
    if (!input.bytes() && std::filesystem::is_regular_file(input.path(), unknown)) {
      return read(InputFile(input.path()));
    }
  }
  Array<char> room;
  return read(input.text(room, stage, Reader::kFirst));
}

}  // namespace hexhex::io
