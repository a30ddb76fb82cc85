#include "output.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <system_error>
#include <unistd.h>

#include <fmt/core.h>

#include <hexhex/error.hpp>

namespace hexhex::command {
namespace {

/// Whether two names mean one file, or would once both are written.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code missing;
  if (std::filesystem::equivalent(a, b, missing)) return !std::filesystem::is_other(a, missing);
  const auto whole = [](const std::filesystem::path& file) {
    std::error_code error;
    std::filesystem::path path =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
    return error ? file : path;
  };
  return whole(a) == whole(b) && !std::filesystem::is_other(a, missing);
}

[[noreturn]] void failToWrite(const std::filesystem::path& file, int error) {
  throw Error(ErrorCode::FileWrite,
              fmt::format("{}: the file cannot be written: {}.", file.string(),
                          std::generic_category().message(error)));
}

}  // namespace

void printLine(std::string_view label, std::string_view value) {
  fmt::print("  {:<26}{}\n", label, value);
}

void printWarning(std::string_view sentence) { printToStderr("hexhex: warning: {}\n", sentence); }

void printError(const Error& error) {
  const std::string place = toString(error.place());
  printToStderr("hexhex: error: {} [{}{}{}]\n", error.what(), name(error.code()),
                place.empty() ? "" : ", ", place);
}

std::string counted(std::uint64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string bytesAsText(std::uint64_t bytes) {
  constexpr double kMega = 1e6;
  if (bytes < 100'000) return fmt::format("{} bytes", bytes);
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) / kMega);
}

std::string checksumAsText(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

std::string valencesAsText(const std::map<int, std::uint64_t>& countByValence) {
  std::string text;
  for (const auto& [valence, count] : countByValence) {
    text += fmt::format("{}{} of valence {}", text.empty() ? "" : ", ", count, valence);
  }
  return text.empty() ? "none" : text;
}

std::string qualityAsText(const QualitySummary& quality) {
  const std::string inverted = quality.notPositive == 0
                                   ? "all positive"
                                   : counted(quality.notPositive, "cell") + " not positive";
  return fmt::format("at least {:.4g}, {:.4g} on average; {}", quality.minimum, quality.mean,
                     inverted);
}

void requireDifferent(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (!sameFile(a, b)) return;
  throw Error(ErrorCode::InvalidArgument, a.string() + " and " + b.string() +
                                              " are the same file. Each file that is read or "
                                              "written needs a name of its own.");
}

void requireWritable(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) failToWrite(file, EISDIR);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) == 0) return;
  const int error = errno;
  throw Error(ErrorCode::FileWrite,
              fmt::format("{}: no file can be created in the folder {}: {}.", file.string(),
                          folder.string(), std::generic_category().message(error)));
}

void writeTextFile(const std::filesystem::path& file, std::string_view text) {
  // A device or pipe cannot be replaced, only written.
  std::error_code ignored;
  const bool direct =
      std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
  std::filesystem::path temporary = file;
  if (!direct) temporary.replace_filename(fmt::format(".hexhex-{}-report.tmp", ::getpid()));
  std::FILE* const stream = std::fopen(temporary.c_str(), "wb");
  if (stream == nullptr) failToWrite(file, errno);
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const bool closed = std::fclose(stream) == 0;
  if (!written || !closed) {
    const int error = errno;
    if (!direct) std::filesystem::remove(temporary, ignored);
    failToWrite(file, error);
  }
  if (direct) return;
  std::error_code renaming;
  std::filesystem::rename(temporary, file, renaming);
  if (!renaming) return;
  std::filesystem::remove(temporary, ignored);
  failToWrite(file, renaming.value());
}

}  // namespace hexhex::command
