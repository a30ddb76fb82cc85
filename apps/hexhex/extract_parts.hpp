// `hexhex extract --parts`: a mesh that never stands in memory as a whole, from a map into a file
// for each part.
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

/// What the command line says about parts.
struct PartsChoice {
  std::optional<std::uint32_t> parts;  ///< empty: one mesh
  PartOptions options;
  bool mpi = false;  ///< join other processes even if nothing says that there are any

  /// Whether something is said of parts, of which there may be none.
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

/// What is known of a mesh that was written in parts.
struct PartsRecord {
  PartOptions options;
  PartsSummary summary;
};

/// "partition of 8 parts": lines for the terminal.
void printParts(const PartsRecord& record);

/// Extracts a mesh into a file for each part. That parts make up one mesh is checked before the
/// files get their names.
/// @param team  the processes that make a part each, or null: this one makes all
/// @throws Error  as extractParts() and openPartSink(); VerificationFailed
[[nodiscard]] PartsRecord extractInParts(const TetMap& map, const std::filesystem::path& output,
                                         const WriteOptions& writing,
                                         const ExtractOptions& extraction,
                                         const PartOptions& options, ProcessTeam* team,
                                         Context& context, ExtractStatistics& statistics);

}  // namespace hexhex::command
