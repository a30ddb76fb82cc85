// Printing: warnings, labelled lines, sizes; and checks of output files.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/patches.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

#include <io/core/output_file.hpp>

namespace hexhex::command {

/// Prints to standard error. Failures to print are ignored: a closed terminal must not cost the
/// result.
template <class... Args>
void printToStderr(fmt::format_string<Args...> format, Args&&... args) {
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

/// Replaces control characters of names and file contents, which a terminal would execute.
[[nodiscard]] std::string printable(std::string_view text);

/// Prints "from -> to" to standard output, and an optional remark.
void printFiles(const std::filesystem::path& from, const std::filesystem::path& to,
                std::string_view besides = "");

/// Prints "  label      value" to standard output.
void printLine(std::string_view label, std::string_view value);

/// Prints "hexhex: warning: <sentence>" to standard error.
void printWarning(std::string_view sentence);

/// "1 cell", "12 cells", "12 vertices".
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view noun);

/// "12.3 MB"
[[nodiscard]] std::string bytesAsText(std::uint64_t bytes);

/// Prints the message to standard error, with details for scripts and bug reports in brackets.
void printError(const Error& error);
/// @param sentence  replaces the error's message
void printError(const Error& error, std::string_view sentence);

/// 16 hexadecimal digits.
[[nodiscard]] std::string checksumAsText(std::uint64_t checksum);

/// "12 of valence 3, 4 of valence 5", or "none".
[[nodiscard]] std::string valencesAsText(const std::map<int, std::uint64_t>& countByValence);

/// Prints two lines: the scaled Jacobian at corners and everywhere, and whether cells are positive.
void printQuality(const Certificate& certificate);

/// Prints a table of the boundary: name, quads, area, centre and normal of at most 20 patches.
void printPatches(std::span<const NamedPatch> patches);

/// A sentence about the cells that are not positive, and where they are.
[[nodiscard]] std::string refutationAsText(const Certificate& certificate);

/// Throws InvalidArgument if options are incompatible.
void refuseIf(bool isRefused, const std::string& sentence);

/// Throws InvalidArgument if an output has the same file as another output or an input, or would
/// once both are written. Names may be empty.
void requireAllDifferent(std::vector<std::filesystem::path> files,
                         std::initializer_list<std::string> outputs);

/// Throws FileWrite if the file is a folder or a dangling link, or no file can be created in its
/// folder: to fail before long work.
/// @param makesFolders  whether folders of an OpenFOAM case are created
void requireWritable(const std::filesystem::path& file, bool makesFolders = true);

/// The destination of a report: a file, or "-" for standard output, which then receives nothing
/// else; or none.
class Report {
 public:
  /// @throws Error FileWrite, before long work
  explicit Report(const std::string& file);

  [[nodiscard]] bool isWanted() const noexcept { return file_ != nullptr || isOnOutput_; }
  [[nodiscard]] bool isOnOutput() const noexcept { return isOnOutput_; }
  void write(const std::string& text);

 private:
  bool isOnOutput_;
  std::unique_ptr<io::OutputFile> file_;
};

/// Throws VerificationFailed, listing the failed checks, unless all passed.
/// @param problem  beginning of the message: what happened
/// @param advice   end of the message: what to do
void requirePassed(const VerifyReport& report, std::string_view problem, std::string_view advice);

/// The map used by an extraction: the caller's, or the repaired one.
[[nodiscard]] inline TetMapView extractedMap(const TetMapView& map, const RepairedMap* repaired) {
  return repaired != nullptr && repaired->map ? TetMapView(*repaired->map) : map;
}

}  // namespace hexhex::command
