#include <algorithm>

#include <base/short_number.hpp>
#include <repair/repair_errors.hpp>

namespace hexhex::repairs {

namespace {

std::string timesAsText(std::uint64_t count) {
  return count == 1 ? "once" : std::to_string(count) + " times";
}

}  // namespace

void throwWithoutSolver(const igm::DefectCollector& defects) {
  const Defect first = defects.defects().front();
  throw Error(first.code,
              first.sentence +
                  " A repair might help, but this build of hexhex cannot repair maps: it was made "
                  "without Eigen. Build it again where that is installed (on Debian "
                  "libeigen3-dev), or compute the map again.",
              first.worst.empty() ? Place{} : first.worst.front().place);
}

void throwHopeless(const igm::DefectCollector& hopeless, std::size_t badTets, bool rounds) {
  const std::vector<Defect> list = hopeless.defects();
  const Defect& first = list.front();
  const Defect::Occurrence& worst = first.worst.front();
  std::string message = first.sentence + " Found " + timesAsText(first.count) +
                        ", and not because of flipped tets; worst at " + toString(worst.place) +
                        (worst.amount > 0 ? " (by " + shortNumber(worst.amount) + ")" : "") + ".";
  double largest = worst.amount;
  for (std::size_t i = 1; i < list.size(); ++i) {
    message += (i == 1 ? " Also " : ", ") + std::string(name(list[i].code)) + " " +
               timesAsText(list[i].count);
    largest = std::max(largest, list[i].worst.front().amount);
  }
  if (list.size() > 1) message += ".";
  if (badTets > 0) {
    message += " The map has " + std::to_string(badTets) +
               " flipped or flat tets as well; repairing them would not make it valid.";
  }
  message += " What the integers were meant to be would be a guess, so nothing was repaired";
  message += largest > 0 && largest <= kRoundingLimit && !rounds
                 ? ": all amounts are below 0.1, so rounding (--round) can be asked for."
                 : ". `hexhex check` lists the places.";
  throw Error(first.code, message, worst.place);
}

void throwImpossible(const PatchEdge& edge) {
  throw Error(ErrorCode::TransitionResidual,
              "The charts around edge " + std::to_string(edge.vertex0) + "-" +
                  std::to_string(edge.vertex1) +
                  " are related in a way that no integer-grid map has: going around it turns "
                  "the grid, but not about the edge. It is close to flipped or flat tets, but "
                  "cannot be repaired without guessing. Compute the map again, or align this "
                  "edge to the grid.",
              {PlaceKind::Edge, edge.vertex0, edge.vertex1});
}

void refuseOffLattice(const std::vector<PatchVertex>& vertices, double limit, bool rounds) {
  const auto worst =
      std::max_element(vertices.begin(), vertices.end(),
                       [](const PatchVertex& a, const PatchVertex& b) { return a.off < b.off; });
  if (worst == vertices.end() || worst->off <= limit) return;
  std::string message = std::string("Vertex ") + std::to_string(worst->vertex) + " is " +
                        (worst->singular ? "on a singular edge" : "on the boundary") + " and " +
                        shortNumber(worst->off) +
                        " off the integer grid, near flipped or flat tets. What the integers "
                        "were meant to be would be a guess, so nothing was repaired. Snap it in "
                        "the program that made the map";
  message += worst->off <= kRoundingLimit && !rounds ? ", or allow rounding (--round)." : ".";
  throw Error(worst->singular ? ErrorCode::SingularityOffLattice : ErrorCode::BoundaryOffLattice,
              message, {PlaceKind::Vertex, worst->vertex});
}

}  // namespace hexhex::repairs
