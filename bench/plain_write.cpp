#include "plain_write.hpp"

#include <algorithm>
#include <fcntl.h>
#include <random>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace hexhex::bench {

TemporaryFolder::TemporaryFolder()
    : path_(std::filesystem::temp_directory_path() /
            ("hexhex_bench_" + std::to_string(std::random_device()()))) {
  std::filesystem::create_directory(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

const TemporaryFolder& folder() {
  static const TemporaryFolder folder;
  return folder;
}

double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double secondsOfPlainWrite(std::uint64_t bytes) {
  constexpr std::size_t kSlice = std::size_t{1} << 22;
  static const std::vector<char> slice(kSlice, 'x');
  const std::filesystem::path file = folder() / "plain";
  const auto begin = std::chrono::steady_clock::now();
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  while (bytes > 0) {
    const ssize_t written =
        ::write(descriptor, slice.data(), std::min<std::uint64_t>(bytes, kSlice));
    if (written <= 0) break;
    bytes -= static_cast<std::uint64_t>(written);
  }
  ::close(descriptor);
  const double seconds = secondsSince(begin);
  std::filesystem::remove(file);
  return seconds;
}

}  // namespace hexhex::bench
