#include <hexhex/error.hpp>

namespace hexhex {

std::string_view name(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return "InvalidArgument";
    case ErrorCode::FileNotFound:
      return "FileNotFound";
    case ErrorCode::FileSyntax:
      return "FileSyntax";
    case ErrorCode::FileUnsupported:
      return "FileUnsupported";
    case ErrorCode::FileWrite:
      return "FileWrite";
    case ErrorCode::EmptyMesh:
      return "EmptyMesh";
    case ErrorCode::IndexOutOfRange:
      return "IndexOutOfRange";
    case ErrorCode::RepeatedVertex:
      return "RepeatedVertex";
    case ErrorCode::NotFinite:
      return "NotFinite";
    case ErrorCode::NonManifoldFace:
      return "NonManifoldFace";
    case ErrorCode::NonManifoldEdge:
      return "NonManifoldEdge";
    case ErrorCode::NonManifoldVertex:
      return "NonManifoldVertex";
    case ErrorCode::Orientation:
      return "Orientation";
    case ErrorCode::TransitionResidual:
      return "TransitionResidual";
    case ErrorCode::BoundaryOffLattice:
      return "BoundaryOffLattice";
    case ErrorCode::SingularityOffLattice:
      return "SingularityOffLattice";
    case ErrorCode::FlippedTet:
      return "FlippedTet";
    case ErrorCode::HalfIntegerFixedPoint:
      return "HalfIntegerFixedPoint";
    case ErrorCode::TooLarge:
      return "TooLarge";
    case ErrorCode::Cancelled:
      return "Cancelled";
    case ErrorCode::OutOfMemory:
      return "OutOfMemory";
    case ErrorCode::VerificationFailed:
      return "VerificationFailed";
    case ErrorCode::Internal:
      return "Internal";
  }
  return "Unknown";
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
