// Folders that appear complete or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <hexhex/error.hpp>

namespace hexhex::io {

/// The same error, with the name of the target in place of that of a temporary.
[[nodiscard]] Error inTermsOf(const std::filesystem::path& target,
                              const std::filesystem::path& temporary, const Error& error);

/// A folder that is filled beside its target and takes the target's place by commit(). Without
/// commit() it vanishes, with the folders above it that it took, and the target stays as it was.
///
/// What else there was in the target is in the new folder, too. Every function throws Error
/// FileWrite, with the target and the system's reason, if it fails.
class OutputFolder {
 public:
  explicit OutputFolder(const std::filesystem::path& target);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where its files are to be written.
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Puts the folder in the place of its target, in one step where the file system knows how to:
  /// otherwise there is a moment when the target is missing.
  void commit();
  /// Undoes commit(), as long as this lives, as far as that is possible.
  void takeBack() noexcept;

  /// The same error, in terms of the target instead of the temporary.
  [[nodiscard]] Error named(const Error& error) const;

 private:
  void takeName();
  void makeParents();
  void removeParents() noexcept;
  void carryOver() const;

  /// Looking into a folder, to remove it, takes memory, of which there may be none then: that of
  /// four folders inside of each other.
  static constexpr std::size_t kSpareBytes = std::size_t{4} * 40 * 1024;

  std::vector<char> spare_ = std::vector<char>(kSpareBytes);
  std::filesystem::path target_;
  std::filesystem::path temporary_;             ///< after commit() what there was before
  std::filesystem::path aside_;                 ///< a name for the time between two steps
  std::vector<std::filesystem::path> parents_;  ///< that were missing, innermost first
  bool replaces_ = false;                       ///< there was a folder before
  bool committed_ = false;
};

}  // namespace hexhex::io
