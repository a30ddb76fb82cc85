// The only exception type of the library, with a code, a message, and a place.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include <hexhex/export.h>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Error codes. Their names are stable; docs/user/errors.md explains each of them.
enum class ErrorCode {
  InvalidArgument,     ///< an option or array is out of range
  FileNotFound,        ///< the file cannot be opened for reading
  FileSyntax,          ///< the file's content violates its format
  FileUnsupported,     ///< unknown format or unsupported variant
  FileWrite,           ///< the file cannot be written completely
  EmptyMesh,           ///< no tets
  IndexOutOfRange,     ///< a tet names a vertex that does not exist
  RepeatedVertex,      ///< a tet names one vertex twice
  NotFinite,           ///< a coordinate or parameter is NaN or infinite
  NonManifoldFace,     ///< a triangle is shared by more than two tets
  NonManifoldEdge,     ///< the tets around an edge do not form a single fan
  NonManifoldVertex,   ///< the tets around a vertex do not form a single ball
  Orientation,         ///< neighbouring tets list their corners in opposite orientations
  TransitionResidual,  ///< (IGM1) a transition between charts is not an integer-grid automorphism
  BoundaryOffLattice,  ///< (IGM2) a boundary triangle does not lie on an integer plane
  SingularityOffLattice,  ///< (IGM3) a singular edge or node does not lie on the integer grid
  FlippedTet,             ///< (IGM4) a tet is flipped or degenerate in the map
  HalfIntegerFixedPoint,  ///< the transitions around a vertex have no fixed point on the lattice
  TooLarge,               ///< a size or coordinate exceeds what the library can represent
  Cancelled,              ///< the caller cancelled the work
  OutOfMemory,            ///< memory is exhausted
  VerificationFailed,     ///< the result does not match the map
  Internal,               ///< a bug in this library
  AmbiguousMesh,  ///< a cell surrounds an inner edge: some of its faces have the same vertices
  NotMeshable     ///< no valid map of the part was found
};

/// The name of a code, e.g. "FlippedTet".
[[nodiscard]] std::string_view name(ErrorCode code) noexcept;

// GCC warns that a scoped enumerator with the name of a type shadows it, which it cannot do.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif
/// The kind of element that an error refers to.
enum class PlaceKind : std::uint8_t { None, Tet, Face, Edge, Vertex, Line, Cell };
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

/// Location of an error: a tet; a face (tet, opposite corner); an edge (two vertices); a vertex; a
/// line of a file (1-based); or a hex cell.
struct Place {
  PlaceKind kind = PlaceKind::None;
  std::uint64_t index = 0;
  std::uint64_t second = 0;
};

/// Text such as "tet 12", "edge 3-17" or "line 4"; empty if there is no place.
[[nodiscard]] std::string toString(const Place& place);

/// Thrown by every function of the library that fails. what() is a full sentence that states what
/// is wrong, where, and what to do.
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
