// Where benchmarks write files, and the yardstick beside them: plainly writing as many bytes.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace hexhex::bench {

/// A folder for temporary files; it lives as long as this object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// The one of all benchmarks.
[[nodiscard]] const TemporaryFolder& folder();

[[nodiscard]] double secondsSince(std::chrono::steady_clock::time_point begin);

/// Of a file, or of all files in a folder: some formats are folders.
[[nodiscard]] std::uint64_t bytesOf(const std::filesystem::path& file);

/// Seconds for writing as many bytes into one file, from memory that is in use already.
[[nodiscard]] double secondsOfPlainWrite(std::uint64_t bytes, int threads = 1);

}  // namespace hexhex::bench
