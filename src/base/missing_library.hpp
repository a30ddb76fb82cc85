// The error of a build that lacks a library.
#pragma once

#include <filesystem>
#include <string_view>

#include <hexhex/error.hpp>

#include <base/concat.hpp>

namespace hexhex {

/// @param work     what this build cannot do, e.g. "read compressed files"
/// @param library  with the package that has it, e.g. "zlib (zlib1g-dev)"
/// @param instead  another way, e.g. "unpack the file first"; may be empty
/// @param file     that the work is about; empty: none
/// @throws Error FileUnsupported if a file is given, else InvalidArgument
[[noreturn]] inline void failWithoutLibrary(std::string_view work, std::string_view library,
                                            std::string_view instead = {},
                                            const std::filesystem::path& file = {}) {
  throw Error(file.empty() ? ErrorCode::InvalidArgument : ErrorCode::FileUnsupported,
              concat(file, (file.empty() ? "This" : ": this"), " build of hexhex cannot ", work,
                     ". Install ", library, " and build it anew", (instead.empty() ? "" : ", or "),
                     instead, "."));
}

}  // namespace hexhex
