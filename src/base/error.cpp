#include <array>
#include <cstddef>

#include <hexhex/error.hpp>

namespace hexhex {

namespace {

/// In the order of ErrorCode.
constexpr auto kNames =
    std::to_array<std::string_view>({"InvalidArgument",    "FileNotFound",
                                     "FileSyntax",         "FileUnsupported",
                                     "FileWrite",          "EmptyMesh",
                                     "IndexOutOfRange",    "RepeatedVertex",
                                     "NotFinite",          "NonManifoldFace",
                                     "NonManifoldEdge",    "NonManifoldVertex",
                                     "Orientation",        "TransitionResidual",
                                     "BoundaryOffLattice", "SingularityOffLattice",
                                     "FlippedTet",         "HalfIntegerFixedPoint",
                                     "TooLarge",           "Cancelled",
                                     "OutOfMemory",        "VerificationFailed",
                                     "Internal",           "AmbiguousMesh",
                                     "NotMeshable"});
static_assert(kNames.size() == static_cast<std::size_t>(ErrorCode::NotMeshable) + 1);

}  // namespace

std::string_view name(ErrorCode code) noexcept {
  const auto index = static_cast<std::size_t>(code);
  return index < kNames.size() ? kNames[index] : "Unknown";
}

std::string toString(const Place& place) {
  const std::string first = std::to_string(place.index);
  switch (place.kind) {
    case PlaceKind::None:
      return "";
    case PlaceKind::Tet:
      return "tet " + first;
    case PlaceKind::Face:
      return "face of tet " + first + " opposite corner " + std::to_string(place.second);
    case PlaceKind::Edge:
      return "edge " + first + "-" + std::to_string(place.second);
    case PlaceKind::Vertex:
      return "vertex " + first;
    case PlaceKind::Line:
      return "line " + first;
    case PlaceKind::Cell:
      return "cell " + first;
  }
  return "";
}

}  // namespace hexhex
