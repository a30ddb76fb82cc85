// Files that get their names together, few of which are open at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <hexhex/team.hpp>

#include <io/core/output_file.hpp>

namespace hexhex::io {

// Sinks work in one process, without a team, or in each process of one.
[[nodiscard]] inline bool isFirst(const ProcessTeam* team) {
  return team == nullptr || team->rank() == 0;
}
inline void agree(ProcessTeam* team) {
  if (team != nullptr) team->agree();
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

}  // namespace hexhex::io
