// Runs a reader over a file, or over its bytes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/context.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/input_file.hpp>

namespace hexhex {

/// @tparam Reader  made from a text, a name for error messages and a stage; has read()
/// @param more  what else the reader's constructor takes
template <class Reader, class... More>
[[nodiscard]] auto parseWith(std::string_view text, const std::string& fileName,
                             std::string_view stageName, Context& context, const More&... more) {
  Stage stage(context, stageName);
  decltype(std::declval<Reader&>().read()) result;
  withThreads(context.threads(), [&] { result = Reader(text, fileName, stage, more...).read(); });
  return result;
}

/// The same of a file.
template <class Reader, class... More>
[[nodiscard]] auto readWith(const std::filesystem::path& file, std::string_view stageName,
                            Context& context, const More&... more) {
  Stage stage(context, stageName);
  decltype(std::declval<Reader&>().read()) result;
  withThreads(context.threads(), [&] {
    const Array<char> bytes = readWholeFile(file, stage);
    result = Reader(asText(bytes), file.string(), stage, more...).read();
  });
  return result;
}

/// The same for readers that can be made from an open file, so that a regular file is never in
/// memory as a whole.
template <class Reader>
[[nodiscard]] auto readDirectly(const std::filesystem::path& file, std::string_view stageName,
                                Context& context) {
  Stage stage(context, stageName);
  const std::string fileName = file.string();
  decltype(std::declval<Reader&>().read()) result;
  withThreads(context.threads(), [&] {
    const InputFile input(file);
    if (input.isRegular()) {
      result = Reader(input, fileName, stage).read();
    } else {
      const Array<char> bytes = readWholeFile(file, stage);
      result = Reader(asText(bytes), fileName, stage).read();
    }
  });
  return result;
}

}  // namespace hexhex
