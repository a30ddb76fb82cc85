// A file that gets its name only when its content has been looked at.
#pragma once

#include <filesystem>

#include <hexhex/error.hpp>

namespace hexhex::command {

/// Throws FileWrite if the file is there but cannot be read back after it was written (a folder, a
/// device, a pipe), or is a link to nowhere.
void requireReadableBack(const std::filesystem::path& file);

/// A name beside the target, with its extension, for a file that somebody else writes. keep()
/// renames the file to the target; without keep() the file vanishes, and the target stays as it
/// was.
class PendingFile {
 public:
  /// @throws Error  as requireReadableBack()
  explicit PendingFile(const std::filesystem::path& target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return pending_; }

  /// @throws Error FileWrite
  void keep();

  /// The same error, in terms of the target instead of the name that nobody has heard of.
  [[nodiscard]] Error named(const Error& error) const;

 private:
  std::filesystem::path target_;   ///< as given, for sentences
  std::filesystem::path real_;     ///< what it is if it is a link
  std::filesystem::path pending_;  ///< in the folder of `real_`
};

}  // namespace hexhex::command
