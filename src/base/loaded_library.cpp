#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <hexhex/types.hpp>

#include <base/loaded_library.hpp>

#if __has_include(<dlfcn.h>) && !defined(__EMSCRIPTEN__)
#define HEXHEX_HAS_DLOPEN 1
#include <dlfcn.h>
#endif

namespace hexhex {

#if defined(HEXHEX_HAS_DLOPEN)
namespace {

/// Whether the file itself is missing, and not one that it needs: sentences name what is missing.
bool saysMissing(const std::string& problem, const std::string& file) {
  const auto says = [&](const std::string& words) {
    return problem.find(words) != std::string::npos;
  };
  // In the language of the process; macOS speaks English.
  const bool isMissing = says(std::strerror(ENOENT)) || says("no such file");
  return isMissing && says(file) && !says("needed by") && !says("Library not loaded");
}

}  // namespace
#endif

LoadedLibrary::LoadedLibrary([[maybe_unused]] std::vector<std::string> files,
                             [[maybe_unused]] const char* variable,
                             [[maybe_unused]] bool isGlobal) {
#if defined(HEXHEX_HAS_DLOPEN)
  // HDF5 and all that it depends on take 21 MB of address space.
  static_cast<void>(Array<char>(std::size_t{1} << 25));
  const char* const chosen = variable == nullptr ? nullptr : std::getenv(variable);
  if (chosen != nullptr) files = {chosen};
  problem_.clear();
  for (std::size_t i = 0; isMissing_ && i < files.size(); ++i) {
    library_ = dlopen(files[i].c_str(), RTLD_NOW | (isGlobal ? RTLD_GLOBAL : 0));
    const std::string problem = library_ == nullptr ? dlerror() : "";
    isMissing_ = library_ == nullptr && saysMissing(problem, files[i]);
    problem_ = library_ != nullptr ? "" : problem_ + (i > 0 ? "; " : "") + problem;
  }
  isMissing_ = isMissing_ && chosen == nullptr;
#endif
}

void* LoadedLibrary::address([[maybe_unused]] const char* name) {
  void* found = nullptr;
#if defined(HEXHEX_HAS_DLOPEN)
  if (library_ == nullptr) return nullptr;
  found = dlsym(library_, name);
  if (found == nullptr) problem_ = dlerror();
#endif
  return found;
}

}  // namespace hexhex
