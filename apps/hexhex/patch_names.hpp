// Options that split and name boundary patches: --split-tags and --names.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/types.hpp>

#include "shared_options.hpp"

namespace hexhex::command {

/// New names of boundary groups, by their current names.
class PatchNames {
 public:
  /// Whether to split tagged groups into smooth patches first: NAME_1, NAME_2, ...
  bool split = false;

  /// Reads a file with two words per line: a group's current name, and its new one. '#' begins a
  /// comment.
  void read(const std::filesystem::path& file);

  /// Splits groups, if requested. If there are names: tags smooth patches of an untagged boundary,
  /// and renames groups.
  /// @param angle  of smooth patches, as in namedPatches()
  /// @throws Error InvalidArgument for an unknown group, listing the known ones
  void apply(HexMesh& mesh, double angle, Context& context) const;
  void apply(LagrangeMesh& mesh, double angle, Context& context) const;

  /// Warns of a --patch-angle without effect, unless names or split groups need it.
  void warnOfAngle(const PatchAngle& angle, const HexMesh& mesh, const std::string& file,
                   const WriteOptions& options, Context& context) const;
  void warnOfAngle(const PatchAngle& angle, const LagrangeMesh& mesh, const std::string& file,
                   const WriteOptions& options, Context& context) const;

  /// The file of names; empty: none.
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] bool isGiven() const noexcept { return split || !names_.empty(); }

 private:
  void requireOwnNames(const HexMesh& mesh, const std::vector<NamedPatch>& patches, double angle,
                       Context& context) const;

  std::string file_;
  std::map<std::string, std::string> names_;
};

/// Renames groups and writes a mesh, straight or curved.
void writeNamed(const PatchNames& names, HexMesh& mesh, const std::string& file,
                const WriteOptions& options, Context& context);
void writeNamed(const PatchNames& names, LagrangeMesh& mesh, const std::string& file,
                const WriteOptions& options, Context& context);

/// Adds both options.
void addPatchNames(CLI::App& parser, PatchNames& names);

}  // namespace hexhex::command
