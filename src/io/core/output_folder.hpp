// Folders that appear complete or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/team.hpp>

#include <io/core/output_file.hpp>

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

// Files that get their names together, few of which are open at a time.

// Sinks work in one process, without a team, or in each process of one.
[[nodiscard]] inline bool isFirst(const ProcessTeam* team) {
  return team == nullptr || team->rank() == 0;
}
inline void barrier(ProcessTeam* team) {
  if (team != nullptr) team->barrier();
}

/// One file for each part, side by side; in a team, those of all processes get names, or none.
class FileSet {
 public:
  explicit FileSet(ProcessTeam* team) : team_(team) {}

  /// Begins the file of the next part.
  OutputFile& add(const std::filesystem::path& file) {
    files_.push_back({file, std::make_unique<OutputFile>(file, OutputFile::Target::Regular)});
    return *files_.back().output;
  }
  /// Puts the last file aside.
  void finishLast() { files_.back().output->suspend(); }

  [[nodiscard]] std::size_t size() const noexcept { return files_.size(); }

  /// Calls change(file) for each file, by writeBytesAt(), and names all. If one cannot be named,
  /// those before it vanish.
  void commit(const std::function<void(std::size_t i, OutputFile& file)>& change = nullptr);

 private:
  struct File {
    std::filesystem::path path;
    std::unique_ptr<OutputFile> output;
  };
  ProcessTeam* team_;
  std::vector<File> files_;
};

/// The number of a part with as many digits as the last one has.
[[nodiscard]] std::string padded(std::uint32_t part, std::uint32_t parts);

/// @param what  "OpenFOAM's decomposed cases"
/// @throws Error FileUnsupported if ghosts are asked for
void refuseGhosts(std::uint32_t layers, const std::string& what);

// A folder with a file for each part, for formats that have one.

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

// One file that the processes of a team write together: each its own bytes.

/// The file is the first process's, and others open its temporary. Without a team, the one of this
/// process. All processes make it, and commit it, together.
class SharedFile {
 public:
  SharedFile(const std::filesystem::path& file, ProcessTeam* team) : team_(team) {
    if (isFirst(team)) output_.emplace(file, OutputFile::Target::Regular);
    if (team == nullptr) return;
    const std::string temporary = team->shareText(output_ ? output_->temporary().string() : "");
    if (!output_) output_.emplace(file, temporary);
  }

  /// In a team, to be written by FilePart.
  [[nodiscard]] OutputFile& output() noexcept { return *output_; }

  void commit() {
    if (!isFirst(team_)) output_->handOver();
    barrier(team_);  // all is written
    if (isFirst(team_)) output_->commit();
    barrier(team_);
  }

 private:
  ProcessTeam* team_;
  std::optional<OutputFile> output_;
};

}  // namespace hexhex::io
