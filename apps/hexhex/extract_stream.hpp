// `hexhex extract --stream`: a mesh that never stands in memory as a whole, from a map into a file
// that gets its name only when it was read back.
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

/// Everything that can be known to fail before long work.
/// @throws Error InvalidArgument for an engine that cannot; FileUnsupported for a format that
///         cannot; FileWrite
void requireStreamable(const std::filesystem::path& output, const WriteOptions& writing,
                       const ExtractOptions& options);

/// What is known of a mesh that was written in pieces.
struct StreamedMesh {
  MeshSummary written;                       ///< of the pieces
  std::optional<VerifyReport> verification;  ///< empty if it was not wanted
};

/// Extracts a mesh piece by piece into a file. If wanted, the file is read again, piece by piece,
/// before it gets its name: it must hold the mesh of the map, which is proven piece by piece, with
/// the checksums of what was extracted. On failure there is no new file.
/// @throws Error  as extractTo(), openMeshSink() and readHexMeshTo(); VerificationFailed
[[nodiscard]] StreamedMesh extractStreamed(const TetMapView& map,
                                           const std::filesystem::path& output,
                                           const WriteOptions& writing,
                                           const ExtractOptions& options, bool verified,
                                           LongRun& longRun, ExtractStatistics& statistics);

}  // namespace hexhex::command
