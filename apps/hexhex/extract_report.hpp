// The output of `hexhex extract`, for people and as JSON. docs/user/report.md explains every key.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/partial.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/summary.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

namespace hexhex::command {

/// Peak memory usage of this process, in bytes.
[[nodiscard]] std::uint64_t peakMemory();

struct FileSize {
  std::filesystem::path file;
  std::uint64_t bytes = 0;
};

/// Arcs or patches that were written.
struct CurvesRecord {
  std::filesystem::path file;  ///< empty if there are none
  std::uint64_t count = 0;     ///< arcs or patches
  std::uint64_t pieces = 0;    ///< inner points or polygons
};

/// Results of writing a mesh in parts.
struct PartsRecord {
  PartOptions options;
  PartsSummary summary;
};

/// The results of an extraction.
struct ExtractionRecord {
  FileSize input;
  FileSize output;
  int scale = 1;
  Engine engine = Engine::Atlas;
  int order = 1;
  CurvedNodes curvedNodes = CurvedNodes::Blended;
  std::uint64_t nodes = 0;  ///< of cells of higher order
  CurvesRecord arcs;
  CurvesRecord patches;
  std::string page;  ///< empty: none
  std::uint64_t points = 0;
  std::uint64_t tets = 0;
  std::uint64_t vertices = 0;
  std::uint64_t cells = 0;
  std::array<std::uint64_t, 3> tags{};  ///< tagged vertices, edges and quads of the mesh
  ExtractStatistics statistics;
  RepairedMap repaired;
  std::vector<Index> straightenedCells;     ///< of higher order: LagrangeMesh::straightenedCells
  std::optional<QuantizeReport> quantized;  ///< empty if the map was not quantized
  std::optional<ImproveReport> improved;    ///< empty if the mesh was not improved
  std::vector<StageTime> stages;
  std::vector<StageTime> parts;  ///< of the whole run: "reading", "extraction", ...
  std::string partsAsText;
  std::optional<std::vector<NamedPatch>> boundary;  ///< empty if not listed
  std::optional<Certificate> certificate;    ///< empty if the mesh was never in memory as a whole
  std::optional<VerifyReport> verification;  ///< empty if skipped
  std::optional<MeshSummary> streamed;       ///< of a mesh written in pieces
  std::optional<PartsRecord> meshParts;      ///< of a mesh written in parts
};

/// The report as JSON text, ending with a line break.
[[nodiscard]] std::string reportAsJson(const ExtractionRecord& record);

/// Prints warnings to standard error.
void printWarnings(const ExtractionRecord& record, const TetMap& map);

/// Prints a line for each notable result.
void printSummary(const ExtractionRecord& record);

/// Prints what a partial extraction left out, in numbers, and the places of the largest holes.
void printPartial(const PartialMesh& partial);

/// The report of a partial extraction, with all holes, as JSON text ending with a line break;
/// docs/user/report.md explains the keys.
/// @param problem  why there is no complete mesh
[[nodiscard]] std::string partialReportAsJson(const PartialMesh& partial, const Error& problem,
                                              int scale);

}  // namespace hexhex::command
