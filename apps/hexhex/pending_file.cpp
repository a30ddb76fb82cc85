#include "pending_file.hpp"

#include <string>
#include <system_error>
#include <unistd.h>

#include <fmt/core.h>

#include <hexhex/io.hpp>

namespace hexhex::command {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorCode::FileWrite,
              fmt::format("{}: the file cannot be written: {}.", file.string(), why));
}

/// What a target is in the end. Renaming onto a link would replace the link.
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

/// Beside `file`, with the extension of `target`, but not its name, which may be as long as the
/// file system allows. As one string: libstdc++'s paths that grow leave a broken path where memory
/// ends.
std::string nameBeside(const std::filesystem::path& file, const std::filesystem::path& target) {
  const std::string folder = file.has_parent_path() ? file.parent_path().string() + '/' : "";
  return fmt::format("{}.hexhex-{}-unread{}", folder, ::getpid(), target.extension().string());
}

}  // namespace

void requireReadableBack(const std::filesystem::path& file) { static_cast<void>(realFile(file)); }

PendingFile::PendingFile(const std::filesystem::path& target)
    : target_(target), real_(realFile(target)), pending_(nameBeside(real_, target)) {}

PendingFile::~PendingFile() {
  std::error_code ignored;  // e.g. if it was never written
  if (!pending_.empty()) std::filesystem::remove(pending_, ignored);
}

void PendingFile::keep() {
  replaceFile(pending_, real_);
  pending_.clear();
}

Error PendingFile::named(const Error& error) const {
  const std::string unknown = pending_.string();
  std::string sentence = error.what();
  const std::size_t place = unknown.empty() ? std::string::npos : sentence.find(unknown);
  if (place != std::string::npos) sentence.replace(place, unknown.size(), target_.string());
  return {error.code(), sentence, error.place()};
}

}  // namespace hexhex::command
