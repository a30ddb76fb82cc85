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
#include <hexhex/types.hpp>

namespace hexhex::command {

/// What the command line says about parts.
struct PartsChoice {
  std::optional<std::uint32_t> parts;  ///< empty: one mesh
  PartOptions options;

  [[nodiscard]] PartOptions chosen() const {
    PartOptions result = options;
    result.parts = parts.value_or(1);
    return result;
  }
};

/// Adds --parts, --ghosts and --partition.
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
/// @throws Error  as extractParts() and openPartSink(); VerificationFailed
[[nodiscard]] PartsRecord extractInParts(const TetMap& map, const std::filesystem::path& output,
                                         const WriteOptions& writing,
                                         const ExtractOptions& extraction,
                                         const PartOptions& options, Context& context,
                                         ExtractStatistics& statistics);

}  // namespace hexhex::command
