// The ways to compress arrays that there are on this machine.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>

namespace hexhex::test {

inline bool isThere(Compression how) {
  WriteOptions options;
  options.compress = how;
  try {
    requireHexMeshFormat("a.vtu", options);
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::FileUnsupported) throw;
    return false;
  }
}

/// With None.
inline std::vector<Compression> compressions() {
  std::vector<Compression> all = {Compression::None, Compression::Zlib, Compression::Lz4};
  std::erase_if(all, [](Compression how) { return !isThere(how); });
  return all;
}

/// What stands behind the name of a format: "vtu-lz4".
inline std::string endingOf(Compression how) {
  if (how == Compression::None) return "";
  return how == Compression::Zlib ? "-zlib" : "-lz4";
}

/// The options that such a name asks for.
inline WriteOptions optionsNamed(std::string_view name) {
  WriteOptions options;
  options.format = name;
  for (const Compression how : {Compression::Zlib, Compression::Lz4}) {
    if (!name.ends_with(endingOf(how))) continue;
    options.compress = how;
    options.format.remove_suffix(endingOf(how).size());
  }
  return options;
}

}  // namespace hexhex::test
