// Output folders that appear complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/team.hpp>

#include <io/core/output_file.hpp>

namespace hexhex::io {

/// The error with the temporary's path replaced by the target's.
[[nodiscard]] Error inTermsOf(const std::filesystem::path& target,
                              const std::filesystem::path& temporary, const Error& error);
/// Runs write(); its errors name the target instead of the temporary.
template <class Write>
void runInTermsOf(const std::filesystem::path& target, const std::filesystem::path& temporary,
                  const Write& write) {
  try {
    write();
  } catch (const Error& error) {
    throw inTermsOf(target, temporary, error);
  }
}

/// A folder that is filled beside its target and replaces it by commit(). Without commit(), it is
/// removed along with the parent folders created for it, and the target is left unchanged.
///
/// Other contents of an existing target are carried over. On failure, every function throws Error
/// FileWrite with the target and the system's reason.
class OutputFolder {
 public:
  explicit OutputFolder(const std::filesystem::path& target);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// The folder to write into.
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Replaces the target, atomically where the file system supports it; elsewhere, the target is
  /// missing for a moment.
  void commit();
  /// Undoes commit() as far as possible.
  void takeBack() noexcept;

  /// Runs write(); its errors name the target instead of the temporary folder.
  template <class Write>
  void run(const Write& write) const {
    runInTermsOf(target_, temporary_, write);
  }

 private:
  void takeName();
  void makeParents();
  void removeParents() noexcept;
  void carryOver() const;

  /// Reserved for the destructor: removing a folder reads its entries, which takes memory that may
  /// have run out. Enough for four nested folders.
  static constexpr std::size_t kSpareBytes = std::size_t{4} * 40 * 1024;

  std::vector<char> spare_ = std::vector<char>(kSpareBytes);
  std::filesystem::path target_;
  std::filesystem::path temporary_;             ///< after commit(): what it replaced
  std::filesystem::path aside_;                 ///< used if folders cannot be exchanged atomically
  std::vector<std::filesystem::path> parents_;  ///< parents created, innermost first
  bool replaces_ = false;                       ///< whether the target existed
  bool committed_ = false;
};

// Sets of files that are renamed together, few of which are open at a time.

// Sinks run in a single process without a team, or in each process of a team.
[[nodiscard]] inline bool isFirst(const ProcessTeam* team) {
  return team == nullptr || team->rank() == 0;
}
inline void barrier(ProcessTeam* team) {
  if (team != nullptr) team->barrier();
}

/// One file per part, side by side. In a team, the files of all processes are renamed, or none.
class FileSet {
 public:
  explicit FileSet(ProcessTeam* team) : team_(team) {}

  /// Writes the file of a part: write(file). Thread-safe.
  template <class Write>
  void write(std::uint32_t part, const std::filesystem::path& file, const Write& write) {
    OutputFile& output = add(part, file);
    write(output);
    output.suspend();
  }

  /// Calls change(part, file), which may use writeBytesAt(), for each file and renames it. If a
  /// file cannot be renamed, those before it are removed.
  void commit(const std::function<void(std::uint32_t part, OutputFile& file)>& change = nullptr);

 private:
  struct File {
    explicit File(const std::filesystem::path& file)
        : path(file), output(file, OutputFile::Target::Regular) {}
    std::filesystem::path path;
    OutputFile output;
  };
  OutputFile& add(std::uint32_t part, const std::filesystem::path& file) {
    const std::lock_guard lock(mutex_);
    return files_.try_emplace(part, file).first->second.output;
  }

  ProcessTeam* team_;
  std::mutex mutex_;
  std::map<std::uint32_t, File> files_;  ///< by part
};

/// The number of a part, zero-padded to the width of the last part's number.
[[nodiscard]] std::string padded(std::uint32_t part, std::uint32_t parts);

/// @param what  subject of the message, e.g. "OpenFOAM's decomposed cases"
/// @throws Error FileUnsupported if ghost layers are requested
void refuseGhosts(std::uint32_t layers, const std::string& what);

// Folders with a file per part.

/// A folder whose part files appear together. Stale files of earlier runs with more parts are
/// removed; other contents are kept. In a team, the first process owns the folder and all processes
/// write into it.
class PartFolder {
 public:
  /// The name of a part's file within the folder.
  using FileName = std::function<std::string(std::uint32_t part)>;

  PartFolder(std::filesystem::path folder, FileName name, ProcessTeam* team)
      : target_(std::move(folder)), name_(std::move(name)) {
    if (isFirst(team)) temporary_ = folder_.emplace(target_).temporary();
    if (team != nullptr) temporary_ = team->shareText(temporary_.string());
  }

  /// Where to write the file of a part.
  [[nodiscard]] std::filesystem::path fileOf(std::uint32_t part) const {
    return temporary_ / name_(part);
  }
  /// Runs write(); its errors name the target instead of the temporary folder.
  template <class Write>
  void run(const Write& write) const {
    runInTermsOf(target_, temporary_, write);
  }
  /// For the first process only, as is takeBack().
  /// @param parts  number of parts
  void commit(std::uint32_t parts);
  void takeBack() noexcept { folder_->takeBack(); }

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::optional<OutputFolder> folder_;  ///< null except in the first process
  FileName name_;
};

// A file written jointly by the processes of a team, each its own bytes.

/// The first process creates the file, and the others open its temporary. Construction and commit()
/// are collective. Without a team, an ordinary file.
class SharedFile {
 public:
  SharedFile(const std::filesystem::path& file, ProcessTeam* team) : team_(team) {
    if (isFirst(team)) output_.emplace(file, OutputFile::Target::Regular);
    if (team == nullptr) return;
    const std::string temporary = team->shareText(output_ ? output_->temporary().string() : "");
    if (!output_) output_.emplace(file, temporary);
  }

  /// In a team, write through FilePart only.
  [[nodiscard]] OutputFile& output() noexcept { return *output_; }

  void commit() {
    if (!isFirst(team_)) output_->handOver();
    barrier(team_);  // wait until all bytes are written
    if (isFirst(team_)) output_->commit();
    barrier(team_);
  }

 private:
  ProcessTeam* team_;
  std::optional<OutputFile> output_;
};

}  // namespace hexhex::io
