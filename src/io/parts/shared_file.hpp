// One file that the processes of a team write together: each its own bytes.
#pragma once

#include <filesystem>
#include <optional>

#include <hexhex/team.hpp>

#include <io/core/output_file.hpp>
#include <io/parts/file_set.hpp>

namespace hexhex::io {

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
    agree(team_);  // all is written
    if (isFirst(team_)) output_->commit();
    agree(team_);
  }

 private:
  ProcessTeam* team_;
  std::optional<OutputFile> output_;
};

}  // namespace hexhex::io
