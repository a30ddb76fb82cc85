#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "support/effort.hpp"

namespace hexhex::test {

/// Seamless maps of real models, as they are published; none without the folder.
inline std::vector<std::filesystem::path> realMaps() {
  const char* chosen = std::getenv("HEXHEX_DATA");
  const auto folder =
      std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "seamless";
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  files.resize(std::min(files.size(), static_cast<std::size_t>(cases(13))));
  return files;
}

}  // namespace hexhex::test
