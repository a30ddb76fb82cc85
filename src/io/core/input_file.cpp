#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/compressed_blocks.hpp>
#include <io/core/input_file.hpp>
#include <io/core/system_call.hpp>
#include <io/core/text_scanner.hpp>

namespace hexhex::io {
namespace {

// Minimum read size for files of unknown size (pipes), large enough that the number of system calls
// does not matter.
constexpr std::size_t kMinimumStep = std::size_t{1} << 20;

// Bytes per read of a thread: large enough that system calls cost nothing, small enough that files
// of a few megabytes keep several threads busy.
constexpr std::size_t kInputFileGrain = std::size_t{1} << 20;

// Enough bytes to recognize a format.
constexpr std::size_t kHead = std::size_t{1} << 16;

std::string reasonOf(int error) { return std::generic_category().message(error); }

/// Whether these may be the first bytes of a file: the first character is one of `first`, and there
/// are no zero bytes in the first word.
bool mayBegin(std::string_view head, std::string_view first) {
  constexpr std::size_t kWord = 8;  // all formats begin with a word or a number in digits
  head = withoutByteOrderMark(head);
  head.remove_prefix(
      static_cast<std::size_t>(std::find_if_not(head.begin(), head.end(), isSpace) - head.begin()));
  return !head.empty() && first.find(head.front()) != std::string_view::npos &&
         head.substr(0, kWord).find('\0') == std::string_view::npos;
}

}  // namespace

InputFile::Descriptor::~Descriptor() {
  if (value >= 0) system_call::close(value);
}

InputFile::InputFile(std::filesystem::path file)
    : path_(std::move(file)), descriptor_{uninterrupted([this] {
        return system_call::openToRead(path_);
      })} {
  system_call::Status status;
  const bool opened =
      descriptor_.value >= 0 && system_call::statusOf(descriptor_.value, status) == 0;
  if (status.isFolder || (!opened && errno == EISDIR)) fail("it is a folder");
  if (!opened) fail(reasonOf(errno));
  regular_ = status.isRegular;
  if (regular_) size_ = status.size;
}

void InputFile::readAt(std::uint64_t position, void* bytes, std::size_t size) const {
  char* place = static_cast<char*>(bytes);
  while (size > 0) {
    const std::ptrdiff_t count = uninterrupted(
        [&] { return system_call::readAt(descriptor_.value, place, size, position); });
    if (count < 0) fail(reasonOf(errno));
    if (count == 0) fail("it became shorter while it was read");
    place += count;
    position += static_cast<std::uint64_t>(count);
    size -= static_cast<std::size_t>(count);
  }
}

std::size_t InputFile::read(void* bytes, std::size_t size) const {
  const std::ptrdiff_t count =
      uninterrupted([&] { return system_call::read(descriptor_.value, bytes, size); });
  if (count < 0) fail(reasonOf(errno));
  return static_cast<std::size_t>(count);
}

void InputFile::moveTo(std::uint64_t position) const {
  if (system_call::moveTo(descriptor_.value, position) < 0) fail(reasonOf(errno));
}

void InputFile::fail(const std::string& reason) const {
  throw Error(ErrorCode::FileNotFound,
              path_.string() + ": the file cannot be read: " + reason + ".");
}

Array<char> readWholeFile(const std::filesystem::path& file, Stage& stage, std::string_view first) {
  const InputFile input(file);
  Array<char> bytes(kHead + 1);
  std::size_t size = 0;
  const auto readOn = [&] {
    const std::size_t count = input.read(bytes.data() + size, bytes.size() - size);
    size += count;
    return count > 0;
  };
  while (size < bytes.size() && readOn()) {
  }
  if (size > kHead && !first.empty() && !mayBegin(asText(bytes), first)) {
    throw Error(ErrorCode::FileSyntax,
                file.string() + ": no file of this format begins with these bytes. Is its " +
                    "extension right, and is it complete?");
  }
  if (input.size() > size) {
    // One byte more than the size, so that reading on finds the end without growing the array.
    bytes.resize(input.size() + 1);
    parallelBlocks(stage, input.size() - size, kInputFileGrain,
                   [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                     input.readAt(size + begin, bytes.data() + size + begin, end - begin);
                   });
    size = input.size();
    input.moveTo(size);
  }
  // The rest: a file of unknown size, or bytes appended in the meantime.
  do {
    if (size == bytes.size()) bytes.resize(size + std::max(size, kMinimumStep));
  } while (readOn());
  bytes.resize(size);
  return bytes;
}

bool isGzip(const std::filesystem::path& file) { return lowerCaseExtension(file) == ".gz"; }

std::string contentExtension(const std::filesystem::path& file) {
  return lowerCaseExtension(isGzip(file) ? file.stem() : file);
}

Input openInput(const std::filesystem::path& file, Context& context) {
  if (!isGzip(file)) return file;
  Stage stage(context, "unpack");
  const Array<char> packed = readWholeFile(file, stage);
  return {file, inflateGzip(asText(packed), file.string())};
}

}  // namespace hexhex::io
