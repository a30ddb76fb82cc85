// What the exit code of the command says; the same table stands in `hexhex --help`.
#pragma once

#include <hexhex/error.hpp>

namespace hexhex::command {

enum ExitCode : int {
  kSuccess = 0,
  kInvalidMap = 1,    ///< the map is no integer-grid map
  kBadUsage = 2,      ///< wrong options or arguments
  kFileProblem = 3,   ///< a file cannot be read, understood, or written
  kFailure = 4,       ///< the result failed its verification, memory was exhausted, or a bug
  kInterrupted = 130  ///< Ctrl-C: 128 plus the number of the signal, as shells do it
};

[[nodiscard]] constexpr ExitCode exitCodeOf(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return kBadUsage;
    case ErrorCode::FileNotFound:
    case ErrorCode::FileSyntax:
    case ErrorCode::FileUnsupported:
    case ErrorCode::FileWrite:
    // The command has its arrays from files, and readers check indices and numbers.
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

}  // namespace hexhex::command
