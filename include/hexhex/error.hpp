// The one exception type of the library: a code, a sentence, and the place.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include <hexhex/export.h>

namespace hexhex HEXHEX_API_NAMESPACE {

/// What went wrong. The names are stable; docs/errors.md explains each.
enum class ErrorCode {
  InvalidArgument,        ///< an option or array is out of range
  FileNotFound,           ///< the file cannot be opened for reading
  FileSyntax,             ///< the file's content breaks its format
  FileUnsupported,        ///< unknown format, or a variant that is not supported
  FileWrite,              ///< the file cannot be written completely
  EmptyMesh,              ///< no tets
  IndexOutOfRange,        ///< a tet names a vertex that does not exist
  RepeatedVertex,         ///< a tet names one vertex twice
  NotFinite,              ///< a coordinate or parameter is NaN or infinite
  NonManifoldFace,        ///< a triangle shared by more than two tets
  NonManifoldEdge,        ///< an edge whose tets do not form one fan
  NonManifoldVertex,      ///< a vertex whose tets do not form one ball
  Orientation,            ///< neighbouring tets list their corners with opposite orientation
  TransitionResidual,     ///< (IGM1) charts do not differ by an integer-grid automorphism
  BoundaryOffLattice,     ///< (IGM2) a boundary triangle is not on an integer plane
  SingularityOffLattice,  ///< (IGM3) a singular edge or node is not on the integer grid
  FlippedTet,             ///< (IGM4) a tet is flipped or degenerate in the map
  HalfIntegerFixedPoint,  ///< transitions around a vertex have no fixed point on the lattice
  TooLarge,               ///< a size or coordinate exceeds what the library represents
  Cancelled,              ///< the caller asked to stop
  OutOfMemory,            ///< memory was exhausted
  VerificationFailed,     ///< the result does not agree with the map
  Internal,               ///< a bug of this library
  AmbiguousMesh,          ///< a cell around an inner edge: faces of it have the same vertices
  NotMeshable             ///< no valid map of the shape was found
};

/// The name of a code, e.g. "FlippedTet".
[[nodiscard]] std::string_view name(ErrorCode code) noexcept;

// GCC reports a scoped enumerator that is named like a type as shadowing it, which it cannot.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif
/// What an error is about.
enum class PlaceKind : std::uint8_t { None, Tet, Face, Edge, Vertex, Line, Cell };
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

/// Where: a tet; a face (tet, corner opposite); an edge (two vertices); a vertex; a line of a file
/// (1-based); a hex cell.
struct Place {
  PlaceKind kind = PlaceKind::None;
  std::uint64_t index = 0;
  std::uint64_t second = 0;
};

/// "tet 12", "edge 3-17", "line 4", or an empty string.
[[nodiscard]] std::string toString(const Place& place);

/// Thrown by every function of the library that fails. what() is a full sentence: what is wrong,
/// where, and what to do.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message, Place place = {})
      : std::runtime_error(message), code_(code), place_(place) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const Place& place() const noexcept { return place_; }

 private:
  ErrorCode code_;
  Place place_;
};

}  // namespace HEXHEX_API_NAMESPACE
