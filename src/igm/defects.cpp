#include <algorithm>
#include <sstream>
#include <string>
#include <tuple>

#include <igm/defects.hpp>

namespace hexhex {

namespace {

/// At most this many places of each kind are kept (a list that a person reads).
constexpr std::size_t kWorst = 10;

/// What is wrong and what to do, in a sentence or two.
const char* explanation(ErrorCode code) {
  switch (code) {
    case ErrorCode::EmptyMesh:
      return "The mesh has no tets. Give a mesh with at least one.";
    case ErrorCode::IndexOutOfRange:
      return "A tet names a vertex that does not exist. Vertices are numbered from 0.";
    case ErrorCode::RepeatedVertex:
      return "A tet names the same vertex twice. Remove collapsed tets from the mesh.";
    case ErrorCode::NotFinite:
      return "A coordinate or parameter is not a finite number. Find out why the program that made "
             "the map wrote it.";
    case ErrorCode::NonManifoldFace:
      return "A triangle belongs to more than two tets. Remove duplicate or overlapping tets.";
    case ErrorCode::NonManifoldEdge:
      return "The tets around an edge do not form one fan. Separate the parts of the mesh that "
             "touch "
             "only there by duplicating the edge's vertices.";
    case ErrorCode::NonManifoldVertex:
      return "The tets around a vertex do not form one ball. Separate the parts of the mesh that "
             "touch only there by duplicating the vertex.";
    case ErrorCode::Orientation:
      return "Neighbouring tets list their corners with opposite orientation. Reorder the corners "
             "(and their parameters) of the tets so that all have positive volume.";
    case ErrorCode::TransitionResidual:
      return "The charts of two neighbouring tets do not differ by a rotation of the integer grid "
             "and "
             "an integer translation (IGM1). Let the map's solver converge further, or raise the "
             "tolerance if the amounts are just above it.";
    case ErrorCode::BoundaryOffLattice:
      return "A boundary triangle does not lie in an integer plane (IGM2). Snap the boundary to "
             "integers in the program that made the map, or raise the tolerance if the amounts are "
             "just above it.";
    case ErrorCode::SingularityOffLattice:
      return "A singular edge does not lie on an integer line, or a singular node not on an "
             "integer "
             "point (IGM3). Snap singularities to integers in the program that made the map, or "
             "raise "
             "the tolerance if the amounts are just above it.";
    case ErrorCode::FlippedTet:
      return "A tet is flipped or degenerate in the map (IGM4). Make the map locally injective, "
             "e.g. "
             "by foldover-free optimization.";
    case ErrorCode::HalfIntegerFixedPoint:
      return "The transitions around a vertex leave no grid-aligned position for it: their fixed "
             "points are at half-integers, or they contradict each other. Quantize the map again.";
    case ErrorCode::TooLarge:
      return "A parameter or a size is larger than the library represents. Translate charts "
             "towards "
             "the origin, or lower the scale.";
    default:
      return "";
  }
}

/// "0.0123" with few digits.
std::string shortNumber(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

bool worse(const Defect::Occurrence& a, const Defect::Occurrence& b) {
  if (a.amount != b.amount) return a.amount > b.amount;
  return std::tie(a.place.kind, a.place.index, a.place.second) <
         std::tie(b.place.kind, b.place.index, b.place.second);
}

}  // namespace

void DefectCollector::add(ErrorCode code, Place place, double amount) {
  if (cornersReversed_ && place.kind == PlaceKind::Face && place.second >= 2) {
    place.second = 5 - place.second;
  }
  const std::lock_guard lock(mutex_);
  Defect& defect = defects_[code];
  if (defect.count == 0) {
    defect.code = code;
    defect.sentence = explanation(code);
  }
  ++defect.count;
  const Defect::Occurrence occurrence{place, amount};
  if (defect.worst.size() == kWorst && !worse(occurrence, defect.worst.back())) return;
  defect.worst.insert(std::upper_bound(defect.worst.begin(), defect.worst.end(), occurrence, worse),
                      occurrence);
  if (defect.worst.size() > kWorst) defect.worst.pop_back();
}

std::vector<Defect> DefectCollector::defects() const {
  std::vector<Defect> list;
  list.reserve(defects_.size());
  for (const auto& [code, defect] : defects_) list.push_back(defect);
  std::stable_partition(list.begin(), list.end(),
                        [&](const Defect& defect) { return defect.code == rootCause_; });
  return list;
}

void DefectCollector::throwIfAny() const {
  if (defects_.empty()) return;
  const Defect defect = defects().front();
  const Defect::Occurrence& worst = defect.worst.front();
  std::string message = defect.sentence;
  const std::string where = toString(worst.place);
  if (!where.empty()) {
    message += defect.count == 1 ? " Found once: at "
                                 : " Found " + std::to_string(defect.count) + " times, worst at ";
    message += where;
    if (worst.amount != 0) message += " (by " + shortNumber(worst.amount) + ")";
    message += ".";
  }
  throw Error(defect.code, message, worst.place);
}

}  // namespace hexhex
