#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include <hexhex/error.hpp>

#include <io/input_file.hpp>

namespace hexhex {
namespace {

// Files without a known size (pipes) are read in steps of at least this many bytes: large enough
// that the number of system calls does not matter.
constexpr std::size_t kMinimumStep = std::size_t{1} << 20;

/// A file descriptor that is closed at the end of the scope.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file)
      : value_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int value() const noexcept { return value_; }

 private:
  int value_;
};

[[noreturn]] void failToRead(const std::filesystem::path& file, const std::string& reason) {
  throw Error(ErrorCode::FileNotFound,
              file.string() + ": the file cannot be read: " + reason + ".");
}

std::string reasonOf(int error) { return std::generic_category().message(error); }

}  // namespace

Array<char> readWholeFile(const std::filesystem::path& file) {
  const Descriptor descriptor(file);
  struct stat status {};
  if (descriptor.value() < 0 || ::fstat(descriptor.value(), &status) != 0) {
    failToRead(file, reasonOf(errno));
  }
  if (S_ISDIR(status.st_mode)) failToRead(file, "it is a folder");

  Array<char> bytes;
  // One byte more than the size, so that the end of the file shows without growing the array.
  if (S_ISREG(status.st_mode)) bytes.resize(static_cast<std::size_t>(status.st_size) + 1);
  std::size_t size = 0;
  while (true) {
    if (size == bytes.size()) bytes.resize(size + std::max(size, kMinimumStep));
    const ssize_t count = ::read(descriptor.value(), bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failToRead(file, reasonOf(errno));
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace hexhex
