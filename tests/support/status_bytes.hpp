// What the system says of this process.
#pragma once

#include <cstddef>
#include <fstream>
#include <string>

namespace hexhex::test {

/// Bytes of memory, as /proc/self/status lists them in kibibytes; 0 where there is no such file.
/// @param key  e.g. "VmRSS:"
inline std::size_t statusBytes(const std::string& key) {
  std::ifstream lines("/proc/self/status");
  for (std::string word; lines >> word;) {
    std::size_t kibibytes = 0;
    if (word == key && lines >> kibibytes) return kibibytes * 1024;
  }
  return 0;
}

}  // namespace hexhex::test
