// How the command prints: warnings, labelled lines, sizes; and files of its own.
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

/// Prints to the standard error output. What cannot be printed there is lost, and nothing else: a
/// closed terminal must not cost the result.
template <class... Args>
void printToStderr(fmt::format_string<Args...> format, Args&&... args) {
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

/// For the terminal, which shall not obey what names of files, or in files, tell it.
[[nodiscard]] std::string printable(std::string_view text);

/// "from -> to" on the standard output, and what is to be said besides.
void printFiles(const std::filesystem::path& from, const std::filesystem::path& to,
                std::string_view besides = "");

/// "  label      value" on the standard output.
void printLine(std::string_view label, std::string_view value);

/// "hexhex: warning: <sentence>" on the standard error output.
void printWarning(std::string_view sentence);

/// "1 cell", "12 cells", "12 vertices".
[[nodiscard]] std::string counted(std::uint64_t count, std::string_view noun);

/// "12.3 MB"
[[nodiscard]] std::string bytesAsText(std::uint64_t bytes);

/// The sentence, and in brackets what a script or a bug report wants to know, on the standard error
/// output.
void printError(const Error& error);
/// @param sentence  in place of the error's
void printError(const Error& error, std::string_view sentence);

/// 16 hexadecimal digits.
[[nodiscard]] std::string checksumAsText(std::uint64_t checksum);

/// "12 of valence 3, 4 of valence 5", or "none".
[[nodiscard]] std::string valencesAsText(const std::map<int, std::uint64_t>& countByValence);

/// Two lines: the scaled Jacobian at corners and everywhere, and whether cells are positive.
void printQuality(const Certificate& certificate);

/// A table of the boundary: name, quads, area, centre and normal of each patch, 20 at most.
void printPatches(std::span<const NamedPatch> patches);

/// Which cells are not positive, and where: a sentence.
[[nodiscard]] std::string refutationAsText(const Certificate& certificate);

/// Throws InvalidArgument for options that do not go together.
void refuseIf(bool isRefused, const std::string& sentence);

/// Throws InvalidArgument if an output and one more file, of those that are read or written, have
/// names that mean one file, or would once both are written. Names may be empty.
void requireAllDifferent(std::vector<std::filesystem::path> files,
                         std::initializer_list<std::string> outputs);

/// Throws FileWrite if the file is a folder or a link to nowhere, or no file can be created in its
/// folder: to fail before long work.
/// @param makesFolders  whether folders of a case of OpenFOAM are made with it
void requireWritable(const std::filesystem::path& file, bool makesFolders = true);

/// A report that is asked for: a file, or "-" for the standard output, which then holds nothing
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

/// Throws VerificationFailed, naming what does not agree, unless all checks passed.
/// @param problem  begins the sentence: what happened
/// @param advice   ends it: what to do
void requirePassed(const VerifyReport& report, std::string_view problem, std::string_view advice);

/// The map that an extraction took: the caller's, or what a repair made of it.
[[nodiscard]] inline TetMapView extractedMap(const TetMapView& map, const RepairedMap* repaired) {
  return repaired != nullptr && repaired->map ? TetMapView(*repaired->map) : map;
}

}  // namespace hexhex::command
