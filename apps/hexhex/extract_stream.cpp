#include "extract_stream.hpp"

#include <memory>
#include <string>
#include <string_view>

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

/// What the file holds: proven right, and the same, bit for bit, as what was written.
VerifyReport compare(VerifyReport report, const MeshSurvey& written, const MeshSurvey& read) {
  const auto add = [&report](const char* item, std::uint64_t expected, std::uint64_t found) {
    report.items.push_back(
        {item, checksumAsText(expected), checksumAsText(found), expected == found});
  };
  add("cell_checksum", written.cellChecksum, read.cellChecksum);
  add("vertex_checksum", written.pointChecksum, read.pointChecksum);
  return report;
}

/// Reads a file piece by piece.
VerifyReport readAndProve(const std::filesystem::path& file, std::string_view format,
                          const TetMapView& map, const VerifyOptions& options,
                          const MeshSurvey& written, Context& context) {
  ReadOptions reading;
  reading.format = format;
  SurveySink read(context);
  VerifySink proof(map, options, context);
  TwoSinks both(read, proof);
  readHexMeshTo(both, file, reading, context);
  return compare(proof.report(), written, read.result());
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
                             bool verified, LongRun& longRun, ExtractStatistics& statistics) {
  Context& context = longRun.context();
  PendingFile pending(output);
  StreamedMesh result;
  try {
    result.written = longRun.part("extraction and writing", [&] {
      SurveySink survey(context);
      const std::unique_ptr<MeshSink> file = openMeshSink(pending.path(), writing, context);
      TwoSinks both(*file, survey);
      extractTo(both, map, options, context, &statistics);
      return survey.result();
    });
    if (verified) {
      const VerifyOptions proof{options.scale, options.tolerance};
      result.verification = longRun.part("verification", [&] {
        return readAndProve(pending.path(), writing.format, extractedMap(map, statistics), proof,
                            result.written, context);
      });
      requirePassed(*result.verification,
                    "The file, as it was read back, does not hold the mesh that was extracted, or "
                    "not the one of the map, and was removed",
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
