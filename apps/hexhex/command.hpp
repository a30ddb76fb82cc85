// The subcommands, each of which adds its options to the parser and returns what to run; and the
// exit codes of the command.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include <hexhex/error.hpp>

namespace hexhex::command {

enum ExitCode : int {
  kSuccess = 0,
  kInvalidMap = 1,    ///< the map is not an integer-grid map
  kBadUsage = 2,      ///< wrong options or arguments
  kFileProblem = 3,   ///< a file cannot be read, is invalid, or cannot be written
  kFailure = 4,       ///< verification failed, memory was exhausted, or a bug
  kInterrupted = 130  ///< Ctrl-C: 128 plus the signal number, as in shells
};

[[nodiscard]] constexpr ExitCode exitCodeOf(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return kBadUsage;
    case ErrorCode::FileNotFound:
    case ErrorCode::FileSyntax:
    case ErrorCode::FileUnsupported:
    case ErrorCode::FileWrite:
    // Arrays come from files, whose readers check indices and numbers.
    case ErrorCode::IndexOutOfRange:
    case ErrorCode::NotFinite:
      return kFileProblem;
    case ErrorCode::EmptyMesh:
    case ErrorCode::RepeatedVertex:
    case ErrorCode::NonManifoldFace:
    case ErrorCode::NonManifoldEdge:
    case ErrorCode::NonManifoldVertex:
    case ErrorCode::Orientation:
    case ErrorCode::TransitionResidual:
    case ErrorCode::BoundaryOffLattice:
    case ErrorCode::SingularityOffLattice:
    case ErrorCode::FlippedTet:
    case ErrorCode::HalfIntegerFixedPoint:
    case ErrorCode::TooLarge:
    case ErrorCode::AmbiguousMesh:
    case ErrorCode::NotMeshable:
      return kInvalidMap;
    case ErrorCode::Cancelled:
      return kInterrupted;
    case ErrorCode::OutOfMemory:
    case ErrorCode::VerificationFailed:
    case ErrorCode::Internal:
      return kFailure;
  }
  return kFailure;
}

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
/// To be added after all other subcommands, which it explains.
[[nodiscard]] Command addHelp(CLI::App& app);

}  // namespace hexhex::command
