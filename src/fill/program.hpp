// Other programs, which run until they end, or until this one ends or is cancelled.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <hexhex/context.hpp>

namespace hexhex::fill {

struct ProgramEnd {
  static constexpr int kNotFound = 127;  ///< as shells say it
  /// The exit code; of a program that a signal ended 128 more than its number.
  int code = 0;
  std::string said;  ///< on both outputs
};

/// Runs a program, and waits for it.
/// @param words   its name, or where it is, and its arguments
/// @param folder  in which it runs, and which receives a file with what it says
/// @throws Error Cancelled, when the program has been ended; FileUnsupported where no programs can
///               be run
[[nodiscard]] ProgramEnd runProgram(const std::vector<std::string>& words,
                                    const std::filesystem::path& folder, Context& context);

/// A folder for files of a moment.
class TemporaryFolder {
 public:
  /// @throws Error FileWrite
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace hexhex::fill
