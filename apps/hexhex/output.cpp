#include "output.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include <hexhex/error.hpp>

namespace hexhex::command {
namespace {

/// Whether two names denote the same file, or would once both are written.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code missing;
  if (std::filesystem::equivalent(a, b, missing)) return !std::filesystem::is_other(a, missing);
  const auto whole = [](const std::filesystem::path& file) {
    std::error_code error;
    std::filesystem::path path = std::filesystem::absolute(file, error);
    if (!error) path = std::filesystem::weakly_canonical(path, error);
    return error ? file : path;
  };
  return whole(a) == whole(b) && !std::filesystem::is_other(a, missing);
}

void requireDifferent(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (!sameFile(a, b)) return;
  throw Error(ErrorCode::InvalidArgument, a.string() + " and " + b.string() +
                                              " are the same file. Each file that is read or "
                                              "written needs a name of its own.");
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown(text);
  for (char& c : shown) {
    constexpr unsigned char kDelete = 0x7f;
    const auto byte = static_cast<unsigned char>(c);
    if (byte < ' ' || byte == kDelete) c = '?';
  }
  return shown;
}

void printFiles(const std::filesystem::path& from, const std::filesystem::path& to,
                std::string_view besides) {
  fmt::print("{} -> {}{}\n", printable(from.string()), printable(to.string()), besides);
}

void printLine(std::string_view label, std::string_view value) {
  fmt::print("  {:<26}{}\n", label, value);
}

void printWarning(std::string_view sentence) {
  printToStderr("hexhex: warning: {}\n", printable(sentence));
}

void printError(const Error& error) { printError(error, error.what()); }

void printError(const Error& error, std::string_view sentence) {
  const std::string place = toString(error.place());
  printToStderr("hexhex: error: {} [{}{}{}]\n", printable(sentence), name(error.code()),
                place.empty() ? "" : ", ", place);
}

std::string counted(std::uint64_t count, std::string_view noun) {
  if (noun == "vertex" && count != 1) return fmt::format("{} vertices", count);
  const bool hisses = noun.ends_with("ch");  // "patches"
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : hisses ? "es" : "s");
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

void printQuality(const Certificate& certificate) {
  if (certificate.validity.empty()) return;
  const QualitySummary& quality = certificate.quality;
  printLine("scaled Jacobian",
            fmt::format("at least {:.4g}, {:.4g} on average", quality.minimum, quality.mean));
  std::string text = "certified positive everywhere";
  if (!certificate.allPositive()) {
    text = counted(certificate.refuted, "cell") + " not positive";
    if (certificate.undecided > 0) text += fmt::format(", {} undecided", certificate.undecided);
  }
  printLine("validity",
            fmt::format("{}; scaled Jacobian at least {:.4g} inside", text, certificate.minimum));
}

void printPatches(std::span<const NamedPatch> patches) {
  if (patches.empty()) return;
  constexpr std::size_t kMost = 20;
  // Print rounding errors as 0.
  const auto vectorAsText = [](const Vec3& vector, double unit) {
    std::string text;
    for (const double x : vector) {
      text += fmt::format("{}{:.3g}", text.empty() ? "(" : ", ", std::abs(x) < unit ? 0 : x);
    }
    return text + ")";
  };
  const auto printRow = [](std::string_view name, const auto& quads, const auto& area,
                           std::string_view centre, std::string_view normal) {
    printLine(name, fmt::format("{:<8} {:<9} {:<33} {}", quads, area, centre, normal));
  };
  printRow("boundary", "quads", "area", "centre", "normal");
  for (const NamedPatch& patch : patches.first(std::min(patches.size(), kMost))) {
    constexpr double kNothing = 1e-6;
    printRow("  " + patch.name, patch.quads.size(), fmt::format("{:.4g}", patch.area),
             vectorAsText(patch.centre, kNothing * std::sqrt(patch.area)),
             vectorAsText(patch.normal, kNothing));
  }
  if (patches.size() > kMost) printLine("  and", counted(patches.size() - kMost, "more patch"));
}

std::string refutationAsText(const Certificate& certificate) {
  const RefutedCell& bad = certificate.worst.front();
  return fmt::format(
      "{} not positive everywhere. The worst is cell {}: its scaled Jacobian is {:.4g} at ({:.3g}, "
      "{:.3g}, {:.3g}) in the cell, at the point ({:.6g}, {:.6g}, {:.6g}).",
      certificate.refuted == 1 ? "1 cell is" : fmt::format("{} cells are", certificate.refuted),
      bad.cell, bad.scaledJacobian, bad.place[0], bad.place[1], bad.place[2], bad.position[0],
      bad.position[1], bad.position[2]);
}

void refuseIf(bool isRefused, const std::string& sentence) {
  if (isRefused) throw Error(ErrorCode::InvalidArgument, sentence);
}

void requireAllDifferent(std::vector<std::filesystem::path> files,
                         std::initializer_list<std::string> outputs) {
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    for (const std::filesystem::path& file : files) {
      if (!file.empty()) requireDifferent(file, output);
    }
    files.emplace_back(output);
  }
}

void requireWritable(const std::filesystem::path& file, bool makesFolders) {
  std::error_code missing;
  // OpenFOAM's case folder is created with the output, or replaced as a folder.
  const bool makesFolder = makesFolders && file.extension() == ".foam" && file.has_parent_path() &&
                           !std::filesystem::exists(file.parent_path(), missing);
  if (makesFolder || file.filename() == "polyMesh") return;
  // Opening a pipe twice would end it.
  if (!std::filesystem::is_other(file, missing)) static_cast<void>(io::OutputFile(file));
}

Report::Report(const std::string& file) : isOnOutput_(file == "-") {
  if (!file.empty() && !isOnOutput_) file_ = std::make_unique<io::OutputFile>(file);
}

void Report::write(const std::string& text) {
  if (isOnOutput_) {
    fmt::print("{}", text);
  } else {
    file_->write(text);
    file_->commit();
  }
}

void requirePassed(const VerifyReport& report, std::string_view problem, std::string_view advice) {
  if (report.passed()) return;
  std::string items;
  for (const VerifyItem& item : report.items) {
    if (item.passed) continue;
    items += fmt::format("{} {}: expected {}, found {}", items.empty() ? "" : ";", item.name,
                         item.expected, item.found);
  }
  throw Error(ErrorCode::VerificationFailed, fmt::format("{}:{}. {}", problem, items, advice));
}

}  // namespace hexhex::command
