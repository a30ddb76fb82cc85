// Runs a reader over a `.vtu` file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/context.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/vtk/vtu_file.hpp>

namespace hexhex {

/// As readWith(), but without the whole file in memory where it can be avoided.
template <class Reader, class... More>
[[nodiscard]] auto readVtuWith(const std::filesystem::path& path, std::string_view stageName,
                               Context& context, const More&... more) {
  Stage stage(context, stageName);
  const std::string fileName = path.string();
  decltype(std::declval<Reader&>().read()) result;
  withThreads(context.threads(), [&] {
    const InputFile input(path);
    if (input.isRegular() && VtuFile::hasPlainAppendedData(input)) {
      result = Reader(input, fileName, stage, more...).read();
      return;
    }
    const Array<char> bytes = readWholeFile(path, stage);
    result = Reader(asText(bytes), fileName, stage, more...).read();
  });
  return result;
}

}  // namespace hexhex
