// A folder with a file for each part, for formats that have one.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <io/core/output_folder.hpp>
#include <io/parts/file_set.hpp>

namespace hexhex::io {

/// Files appear with the folder. Those of earlier runs with more parts are removed; what else is in
/// the folder stays. In a team of processes, the folder is the first one's, and all write into it.
class PartFolder {
 public:
  /// The name of the file of a part, in the folder.
  using FileName = std::function<std::string(std::uint32_t part)>;

  PartFolder(std::filesystem::path folder, FileName name, ProcessTeam* team)
      : target_(std::move(folder)), name_(std::move(name)) {
    if (isFirst(team)) temporary_ = folder_.emplace(target_).temporary();
    if (team != nullptr) temporary_ = team->shareText(temporary_.string());
  }

  /// Where the file of a part is to be written.
  [[nodiscard]] std::filesystem::path fileOf(std::uint32_t part) const {
    return temporary_ / name_(part);
  }
  /// Runs write(), whose errors name the target instead of the temporary folder.
  template <class Write>
  void run(const Write& write) const {
    try {
      write();
    } catch (const Error& error) {
      throw inTermsOf(target_, temporary_, error);
    }
  }
  /// Of the first process, as takeBack().
  /// @param parts  that there are
  void commit(std::uint32_t parts);
  void takeBack() noexcept { folder_->takeBack(); }

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::optional<OutputFolder> folder_;  ///< of the first process
  FileName name_;
};

}  // namespace hexhex::io
