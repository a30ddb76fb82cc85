// `hexhex extract --stream`: extracts a mesh into a file without ever holding it in memory as a
// whole; the file is renamed to its target once it was read back.
#pragma once

#include <filesystem>
#include <optional>

#include <hexhex/context.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/summary.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

#include "long_run.hpp"

namespace hexhex::command {

/// Detects everything that would fail later, before long work.
/// @throws Error InvalidArgument for an engine, FileUnsupported for a format that cannot stream;
///         FileWrite
void requireStreamable(const std::filesystem::path& output, const WriteOptions& writing,
                       const ExtractOptions& options);

/// Results of writing a mesh in pieces.
struct StreamedMesh {
  MeshSummary written;                       ///< of the pieces
  std::optional<VerifyReport> verification;  ///< empty if not requested
};

/// Extracts a mesh piece by piece into a file. If verification is requested, the file is read back
/// piece by piece before it is renamed to its target: it must be the mesh of the map, with the
/// checksums of what was extracted. On failure there is no new file.
/// @throws Error  as extractTo(), openMeshSink() and readHexMeshTo(); VerificationFailed
[[nodiscard]] StreamedMesh extractStreamed(const TetMapView& map,
                                           const std::filesystem::path& output,
                                           const WriteOptions& writing,
                                           const ExtractOptions& options, bool verified,
                                           LongRun& longRun, ExtractStatistics& statistics);

}  // namespace hexhex::command
