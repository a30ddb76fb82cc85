// The subcommands: each adds its options to the parser and says what to do afterwards.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace hexhex::command {

struct Command {
  CLI::App* parser = nullptr;  ///< true after parsing if this subcommand was given
  std::function<int()> run;    ///< returns the exit code; throws hexhex::Error
};

[[nodiscard]] Command addExtract(CLI::App& app);
[[nodiscard]] Command addCheck(CLI::App& app);
[[nodiscard]] Command addVerify(CLI::App& app);
[[nodiscard]] Command addGenerate(CLI::App& app);
[[nodiscard]] Command addRepair(CLI::App& app);
[[nodiscard]] Command addMap(CLI::App& app);
[[nodiscard]] Command addMesh(CLI::App& app);
[[nodiscard]] Command addQuantize(CLI::App& app);
[[nodiscard]] Command addImprove(CLI::App& app);
[[nodiscard]] Command addInfo(CLI::App& app);
[[nodiscard]] Command addConvert(CLI::App& app);
[[nodiscard]] Command addFormats(CLI::App& app);
[[nodiscard]] Command addView(CLI::App& app);
/// After all others, which it explains.
[[nodiscard]] Command addHelp(CLI::App& app);

}  // namespace hexhex::command
