#include "plain_write.hpp"

#include <algorithm>
#include <atomic>
#include <fcntl.h>
#include <random>
#include <system_error>
#include <thread>
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

std::uint64_t bytesOf(const std::filesystem::path& file) {
  if (!std::filesystem::is_directory(file)) return std::filesystem::file_size(file);
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(file)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

double secondsOfPlainWrite(std::uint64_t bytes, int threads) {
  constexpr std::uint64_t kSlice = std::uint64_t{1} << 22;
  static const std::vector<char> slice(kSlice, 'x');
  const std::filesystem::path file = folder() / "plain";
  const auto begin = std::chrono::steady_clock::now();
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::atomic<std::uint64_t> next = 0;
  const auto writeSlices = [&] {
    for (std::uint64_t at = 0; (at = next.fetch_add(kSlice)) < bytes;) {
      for (const std::uint64_t end = std::min(at + kSlice, bytes); at < end;) {
        const ssize_t written =
            ::pwrite(descriptor, slice.data(), end - at, static_cast<off_t>(at));
        if (written <= 0) return;
        at += static_cast<std::uint64_t>(written);
      }
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(writeSlices);
  writeSlices();
  for (std::thread& other : others) other.join();
  ::close(descriptor);
  const double seconds = secondsSince(begin);
  std::filesystem::remove(file);
  return seconds;
}

}  // namespace hexhex::bench
