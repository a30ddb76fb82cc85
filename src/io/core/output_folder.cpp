#include <cerrno>
#include <cstddef>
#include <new>
#include <string>
#include <system_error>

#include <hexhex/error.hpp>

#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/core/system_call.hpp>

namespace hexhex::io {

namespace {

namespace fs = std::filesystem;

/// Swaps the names of two folders, via a third name where the system has no atomic exchange.
/// @return whether it succeeded; otherwise errno gives the reason and nothing has changed
bool exchange(const fs::path& a, const fs::path& b, const fs::path& aside) noexcept {
  if (system_call::exchange(a, b) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  if (system_call::rename(b, aside) != 0) return false;
  if (system_call::rename(a, b) == 0) return system_call::rename(aside, a) == 0;
  const int error = errno;
  static_cast<void>(system_call::rename(aside, b));
  errno = error;
  return false;
}

/// Copies a file, a link, or a folder recursively; on failure, removes the partial copy.
/// @param way  whether files are hard-linked or copied
std::error_code copyAs(const fs::path& from, const fs::path& to, fs::copy_options way) {
  std::error_code error;
  fs::copy(from, to, way | fs::copy_options::recursive | fs::copy_options::copy_symlinks, error);
  std::error_code ignored;
  if (error) fs::remove_all(to, ignored);
  return error;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& target) : target_(realTarget(target)) {
  std::error_code error;
  replaces_ = fs::is_directory(target_, error);
  if (!replaces_ && fs::exists(target_, error))
    failToWrite(target_, "it has to be a folder, and a file of that name is there", ENOTDIR);
  takeName();
  makeParents();
  while (system_call::makeFolder(temporary_) != 0) {
    if (errno != EEXIST) {
      const int reason = errno;
      removeParents();
      failToWrite(target_, "no folder can be created beside it", reason);
    }
    takeName();
  }
}

void OutputFolder::takeName() {
  temporary_ = temporaryBeside(target_);
  aside_ = temporary_.string() + "-aside";
}

OutputFolder::~OutputFolder() {
  std::vector<char>().swap(spare_);
  // Removal takes a descriptor, which may become available a moment later.
  for (int attempt = 0; attempt < 3; ++attempt) {
    try {
      std::error_code error;
      fs::remove_all(temporary_, error);
      if (!error) break;
    } catch (const std::bad_alloc&) {
      continue;
    }
  }
  if (!committed_) removeParents();
}

Error inTermsOf(const fs::path& target, const fs::path& temporary, const Error& error) {
  std::string sentence = error.what();
  const std::size_t place = sentence.find(temporary.string());
  if (place != std::string::npos) {
    sentence.replace(place, temporary.string().size(), target.string());
  }
  return {error.code(), sentence, error.place()};
}

void OutputFolder::makeParents() {
  std::error_code error;
  for (fs::path folder = target_.parent_path(); !folder.empty() && !fs::exists(folder, error);
       folder = folder.parent_path()) {
    parents_.push_back(folder);
  }
  for (std::size_t i = parents_.size(); i-- > 0;) {
    if (system_call::makeFolder(parents_[i]) == 0 || errno == EEXIST) continue;
    const int reason = errno;
    const std::string folder = parents_[i].string();
    removeParents();
    failToWrite(target_, "the folder " + folder + " cannot be created", reason);
  }
}

void OutputFolder::removeParents() noexcept {
  for (const fs::path& folder : parents_) system_call::removeFolder(folder);
}

void OutputFolder::carryOver() const {
  std::error_code error;
  for (fs::directory_iterator entry(target_, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path place = temporary_ / entry->path().filename();
    std::error_code missing;
    if (fs::exists(fs::symlink_status(place, missing))) continue;
    // Hard links take no space, and keep the old folder intact until it is replaced.
    if (!copyAs(entry->path(), place, fs::copy_options::create_hard_links)) continue;
    const std::error_code failure = copyAs(entry->path(), place, fs::copy_options::none);
    if (!failure) continue;
    failToWrite(target_, "what else is in it cannot be kept, " + entry->path().string(),
                failure.value());
  }
  if (error) failToWrite(target_, "it cannot be read", error.value());
}

void OutputFolder::commit() {
  if (replaces_) carryOver();
  ChangedFolder(temporary_ / ".").sync();
  const ChangedFolder folder(target_);
  const bool named = replaces_ ? exchange(temporary_, target_, aside_)
                               : system_call::rename(temporary_, target_) == 0;
  if (!named) failToWrite(target_, "the finished folder cannot be renamed to it", errno);
  committed_ = true;
  try {
    folder.sync();
    for (const fs::path& parent : parents_) ChangedFolder(parent).sync();
  } catch (...) {
    takeBack();
    throw;
  }
}

void OutputFolder::takeBack() noexcept {
  committed_ = false;
  if (replaces_) {
    static_cast<void>(exchange(temporary_, target_, aside_));
  } else {
    static_cast<void>(system_call::rename(target_, temporary_));
  }
}

void FileSet::commit(const std::function<void(std::uint32_t part, OutputFile& file)>& change) {
  barrier(team_);  // wait until all files are written
  try {
    for (auto& [part, file] : files_) {
      file.output.resume();
      if (change) change(part, file.output);
      file.output.commit();
    }
    barrier(team_);
  } catch (...) {
    std::error_code unknown;
    for (auto& [part, file] : files_) {
      if (file.output.isNamed()) std::filesystem::remove(file.path, unknown);
    }
    throw;
  }
}

std::string padded(std::uint32_t part, std::uint32_t parts) {
  std::string number = std::to_string(part);
  const std::size_t digits = std::to_string(parts - 1).size();
  return number.insert(0, digits - number.size(), '0');
}

void refuseGhosts(std::uint32_t layers, const std::string& what) {
  if (layers == 0) return;
  throw Error(ErrorCode::FileUnsupported, what + " hold no ghost cells. Leave out --ghosts.");
}

void PartFolder::commit(std::uint32_t parts) {
  folder_->commit();
  try {
    // Part files beyond the new number of parts are stale.
    std::error_code error;
    for (std::uint32_t part = parts;
         std::filesystem::remove_all(target_ / name_(part), error) > 0;) {
      if (error) break;
      ++part;
    }
  } catch (...) {  // out of memory for a name
    takeBack();
    throw;
  }
}

}  // namespace hexhex::io
