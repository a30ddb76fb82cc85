#include "extract_stream.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>

#include "output.hpp"

namespace hexhex::command {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorCode::FileWrite,
              fmt::format("{}: the file cannot be written: {}.", file.string(), why));
}

/// The target with symbolic links resolved: renaming onto a link would replace the link.
/// @throws Error FileWrite if the target exists but could not be read back (a folder, a device, a
///         pipe), or is a dangling link
std::filesystem::path realFile(const std::filesystem::path& target) {
  std::error_code error;
  std::filesystem::path real = target;
  if (std::filesystem::is_symlink(target, error)) {
    real = std::filesystem::canonical(target, error);
    if (error) fail(target, "its link leads nowhere: " + error.message());
  }
  const std::filesystem::file_status status = std::filesystem::status(real, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail(target, "it is a folder, a device or a pipe, from which it could not be read back");
  }
  return real;
}

/// A name beside `file`, with the extension of `target` but not its name, which may already have
/// the maximum length. Built as one string: growing a libstdc++ path leaves it broken when memory
/// runs out.
std::string nameBeside(const std::filesystem::path& file, const std::filesystem::path& target) {
  const std::string folder = file.has_parent_path() ? file.parent_path().string() + '/' : "";
  return fmt::format("{}.hexhex-{}-unread{}", folder, ::getpid(), target.extension().string());
}

/// A temporary name beside the target, with its extension, for a file written by others. keep()
/// renames the file to the target; without keep(), the file is removed and the target left
/// unchanged.
class PendingFile {
 public:
  /// @throws Error  as realFile()
  explicit PendingFile(const std::filesystem::path& target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return pending_; }

  /// @throws Error FileWrite
  void keep();

  /// The error with the temporary's path replaced by the target's.
  [[nodiscard]] Error named(const Error& error) const;

 private:
  std::filesystem::path target_;   ///< as given, for messages
  std::filesystem::path real_;     ///< with links resolved
  std::filesystem::path pending_;  ///< in the folder of `real_`
};

PendingFile::PendingFile(const std::filesystem::path& target)
    : target_(target), real_(realFile(target)), pending_(nameBeside(real_, target)) {}

PendingFile::~PendingFile() {
  std::error_code ignored;  // e.g. if it was never written
  if (!pending_.empty()) std::filesystem::remove(pending_, ignored);
}

void PendingFile::keep() {
  io::replaceFile(pending_, real_);
  pending_.clear();
}

Error PendingFile::named(const Error& error) const {
  const std::string unknown = pending_.string();
  std::string sentence = error.what();
  const std::size_t place = unknown.empty() ? std::string::npos : sentence.find(unknown);
  if (place != std::string::npos) sentence.replace(place, unknown.size(), target_.string());
  return {error.code(), sentence, error.place()};
}

/// Forwards every call to two sinks in turn.
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

/// Adds to a report whether the file holds exactly what was written, by checksums.
VerifyReport compare(VerifyReport report, const MeshSummary& written, const MeshSummary& read) {
  const auto add = [&report](const char* item, std::uint64_t expected, std::uint64_t found) {
    report.items.push_back(
        {item, checksumAsText(expected), checksumAsText(found), expected == found});
  };
  add("cell_checksum", written.cellChecksum, read.cellChecksum);
  add("vertex_checksum", written.pointChecksum, read.pointChecksum);
  return report;
}

/// Reads a file piece by piece and verifies it against the map.
VerifyReport readAndProve(const std::filesystem::path& file, std::string_view format,
                          const TetMapView& map, const VerifyOptions& options,
                          const MeshSummary& written, Context& context) {
  ReadOptions reading;
  reading.format = format;
  SummarySink read(context);
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
  static_cast<void>(realFile(output));
  // A sink destroyed at once leaves no file, but reports errors.
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
      SummarySink summary(context);
      const std::unique_ptr<MeshSink> file = openMeshSink(pending.path(), writing, context);
      TwoSinks both(*file, summary);
      extractTo(both, map, options, context, &statistics);
      return summary.result();
    });
    if (verified) {
      const VerifyOptions proof{options.scale, options.tolerance};
      result.verification = longRun.part("verification", [&] {
        return readAndProve(pending.path(), writing.format, extractedMap(map, options.repair),
                            proof, result.written, context);
      });
      requirePassed(
          *result.verification,
          "The file, when read back, did not hold the mesh that was extracted, or not the "
          "one of the map, and was removed",
          "Please check the disk; if it is sound, report this with the map.");
    }
    context.throwIfCancelled();
  } catch (const Error& error) {
    throw pending.named(error);
  }
  pending.keep();
  return result;
}

}  // namespace hexhex::command
