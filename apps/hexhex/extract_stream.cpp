#include "extract_stream.hpp"

#include <memory>
#include <string>

#include <hexhex/check.hpp>
#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>

#include "output.hpp"
#include "pending_file.hpp"
#include "verification.hpp"

namespace hexhex::command {
namespace {

/// Hands every call to two sinks, one after the other.
class TwoSinks final : public MeshSink {
 public:
  TwoSinks(MeshSink& first, MeshSink& second) : first_(first), second_(second) {}

  void begin(std::uint64_t pointCount, std::uint64_t cellCount) override {
    first_.begin(pointCount, cellCount);
    second_.begin(pointCount, cellCount);
  }
  void points(const PointPiece& piece) override {
    first_.points(piece);
    second_.points(piece);
  }
  void cells(std::uint64_t first, std::span<const Hex> cells) override {
    first_.cells(first, cells);
    second_.cells(first, cells);
  }
  void cells(std::uint64_t first, std::span<const Hex64> cells) override {
    first_.cells(first, cells);
    second_.cells(first, cells);
  }
  void end() override {
    first_.end();
    second_.end();
  }

 private:
  MeshSink& first_;
  MeshSink& second_;
};

/// The number of vertices that follows from what is expected: a cell has 6 faces and 12 edges, an
/// inner face belongs to 2 cells, a regular edge to 4 or, on the boundary, to 2; and there are
/// twice as many boundary edges as boundary quads. For up to 10^17 cells.
std::int64_t expectedVertices(const Expectation& expected) {
  const auto cells = static_cast<std::int64_t>(expected.cells);
  const auto quads = static_cast<std::int64_t>(expected.boundaryQuads);
  const std::int64_t faces = (6 * cells + quads) / 2;
  const std::int64_t boundaryEdges = 2 * quads;
  std::int64_t aroundRegularInnerEdges = 12 * cells - 2 * boundaryEdges;
  for (const auto& [valence, count] : expected.innerSingularEdges) {
    aroundRegularInnerEdges -= (valence - 4) * static_cast<std::int64_t>(count);
  }
  for (const auto& [valence, count] : expected.boundarySingularEdges) {
    aroundRegularInnerEdges -= (valence - 2) * static_cast<std::int64_t>(count);
  }
  const std::int64_t edges = aroundRegularInnerEdges / 4 + boundaryEdges;
  return expected.eulerCharacteristic + edges - faces + cells;
}

VerifyReport compare(const CheckReport& map, const MeshSurvey& written, const MeshSurvey& read) {
  VerifyReport report;
  const auto add = [&report](const char* item, const std::string& expected,
                             const std::string& found) {
    report.items.push_back({item, expected, found, expected == found});
  };
  add("map_valid", "yes", map.valid() ? "yes" : "no");
  add("cells", std::to_string(map.expected.cells), std::to_string(read.cells));
  add("vertices", std::to_string(expectedVertices(map.expected)), std::to_string(read.points));
  add("cells_read_back", std::to_string(written.cells), std::to_string(read.cells));
  add("vertices_read_back", std::to_string(written.points), std::to_string(read.points));
  add("cell_checksum", checksumAsText(written.cellChecksum), checksumAsText(read.cellChecksum));
  add("vertex_checksum", checksumAsText(written.pointChecksum), checksumAsText(read.pointChecksum));
  return report;
}

}  // namespace

void requireStreamable(const std::filesystem::path& output, const WriteOptions& writing,
                       const ExtractOptions& options) {
  if (options.engine != Engine::Atlas) {
    throw Error(ErrorCode::InvalidArgument,
                "--stream works with the engine atlas only; the engine propeller needs the whole "
                "mesh in memory. Leave out one of --stream and --engine.");
  }
  requireReadableBack(output);
  // A sink that is destroyed at once leaves nothing, but says what is wrong.
  Context context;
  static_cast<void>(openMeshSink(output, writing, context));
}

StreamedMesh extractStreamed(const TetMapView& map, const std::filesystem::path& output,
                             const WriteOptions& writing, const ExtractOptions& options,
                             bool verified, Context& context, ExtractStatistics& statistics) {
  PendingFile pending(output);
  StreamedMesh result;
  ReadOptions reading;
  reading.format = writing.format;
  try {
    SurveySink survey(context);
    {
      const std::unique_ptr<MeshSink> file = openMeshSink(pending.path(), writing, context);
      TwoSinks both(*file, survey);
      extractTo(both, map, options, context, &statistics);
    }
    result.written = survey.result();
    if (verified) {
      const MeshSurvey read = surveyFile(pending.path(), reading, context);
      const CheckReport expected =
          check(extractedMap(map, statistics), {options.tolerance, options.scale}, context);
      result.verification = compare(expected, result.written, read);
      requirePassed(*result.verification,
                    "The file, as it was read back, does not hold the mesh that was extracted, or "
                    "not the one that follows from the map, and was removed",
                    "Please look after the disk, and if it is sound report this with the map.");
    }
    context.throwIfCancelled();
  } catch (const Error& error) {
    throw pending.named(error);
  }
  pending.keep();
  return result;
}

}  // namespace hexhex::command
