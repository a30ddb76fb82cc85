// `hexhex extract --parts`: extracts a mesh into a file per part, without ever holding it in memory
// as a whole.
#pragma once

#include <filesystem>
#include <optional>

#include <CLI/CLI.hpp>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/team.hpp>
#include <hexhex/types.hpp>

namespace hexhex::command {

/// The options for parts.
struct PartsChoice {
  std::optional<std::uint32_t> parts;  ///< empty: one mesh
  PartOptions options;
  bool mpi = false;  ///< join a team even if no other processes are detected

  /// Whether options that require --parts were given.
  [[nodiscard]] bool isOfParts() const noexcept {
    return options.ghostLayers > 0 || options.method != PartitionMethod::Curve;
  }
  [[nodiscard]] PartOptions chosen() const {
    PartOptions result = options;
    result.parts = parts.value_or(1);
    return result;
  }
};

/// Adds --parts, --ghosts, --partition and --mpi.
void addPartsOptions(CLI::App& parser, PartsChoice& choice);

/// Results of writing a mesh in parts.
struct PartsRecord {
  PartOptions options;
  PartsSummary summary;
};

/// Prints lines such as "partition of 8 parts".
void printParts(const PartsRecord& record);

/// Extracts a mesh into a file per part. Checks that the parts make up one mesh before the files
/// are renamed.
/// @param team  processes that extract a part each; null: this process extracts all
/// @throws Error  as extractParts() and openPartSink(); VerificationFailed
[[nodiscard]] PartsRecord extractInParts(const TetMap& map, const std::filesystem::path& output,
                                         const WriteOptions& writing,
                                         const ExtractOptions& extraction,
                                         const PartOptions& options, ProcessTeam* team,
                                         Context& context, ExtractStatistics& statistics);

}  // namespace hexhex::command
