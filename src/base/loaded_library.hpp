// Libraries that are loaded when they are needed, where the system can do so.
#pragma once

#include <string>
#include <vector>

namespace hexhex {

/// A shared library, never unloaded.
class LoadedLibrary {
 public:
  /// Loads the first of these files that is there. If that one cannot be loaded, the others are not
  /// tried: what is used must not depend on whether loading happens to fail.
  /// @param variable  may name, in the environment, the file to load instead; null: there is none
  /// @param isGlobal  whether what is loaded later, such as its plugins, sees its symbols
  /// @throws std::bad_alloc if little memory is left: many libraries crash while they are loaded
  explicit LoadedLibrary(std::vector<std::string> files, const char* variable = nullptr,
                         bool isGlobal = false);

  /// Whether none of the files is there; false if the environment names one.
  [[nodiscard]] bool isMissing() const noexcept { return isMissing_; }
  /// Why no file was loaded, or what find() did not find; empty if all went well.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
  /// @return null if there is no such symbol, or no library
  template <class Function>
  [[nodiscard]] Function find(const char* name) {
    return reinterpret_cast<Function>(address(name));
  }

 private:
  [[nodiscard]] void* address(const char* name);

  void* library_ = nullptr;
  bool isMissing_ = true;
  std::string problem_ = "this build of hexhex loads no libraries";
};

}  // namespace hexhex
