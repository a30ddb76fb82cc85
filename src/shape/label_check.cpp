#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <shape/label_check.hpp>

namespace hexhex::shape {

namespace {

/// A border turns back if it does so by more than this, in mean edges; less is noise of the mesh.
constexpr double kNoise = 0.7;
/// Below this cosine, a triangle is nearly perpendicular to its label: 87 degrees.
constexpr double kPerpendicular = 0.05;

/// @param shape  energy of steep triangles and of the length of borders
double energyOf(const LabelReport& report, double shape) {
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  double energy = report.deviation + shape;
  energy += count(report.badLoops + report.badCorners) + 0.3 * count(report.turningPoints) +
            0.7 * count(report.wrongTurns + report.flatCharts);
  if (report.oppositeEdges > 0) {
    energy += std::floor(1 + count(report.oppositeEdges) / 20) + 0.02 * count(report.oppositeEdges);
  }
  return energy;
}

}  // namespace

LabelCheck::LabelCheck(const Surface& surface, const LabelCosts& costs)
    : surface_(surface),
      costs_(costs),
      windingOf_(surface),
      chartOf_(surface.triangleCount()),
      borderCount_(surface.pointCount),
      isDone_(surface.tails.size()) {
  std::vector<bool> isSeen(surface.pointCount);
  for (Side side = 0; side < surface.tails.size(); ++side) {
    if (!isSeen[surface.tails[side]]) sideAt_.push_back(side);
    isSeen[surface.tails[side]] = true;
  }
}

void LabelCheck::reset() {
  for (const Side border : borders_) {
    borderCount_[surface_.tails[border]] = 0;
    isDone_[border] = false;
  }
  borders_.clear();
  loops_.clear();
  pieces_.clear();
}

void LabelCheck::visitTriangles(const Labels& labels, Verdict& verdict) {
  double deviation = 0;
  double steep = 0;
  double length = 0;
  for (Index t = 0; t < labels.size(); ++t) {
    const double cos = cosine(surface_.normals[t], labels[t]);
    deviation += surface_.areas[t] * (1 - cos);
    if (cos < kPerpendicular) steep += surface_.areas[t] * (kPerpendicular - cos);
    for (Side side = 3 * t; side < 3 * t + 3; ++side) {
      const lattice::Direction beyond = labels[surface_.beyond(side)];
      if (beyond == labels[t]) continue;
      borders_.push_back(side);
      ++borderCount_[surface_.tails[side]];
      if (side > surface_.twins[side]) continue;
      length += costs_.weight(side) * surface_.meanEdge;
      if (lattice::axisOf(beyond) != lattice::axisOf(labels[t])) continue;
      ++verdict.report.oppositeEdges;
      verdict.places.push_back(t);
    }
  }
  verdict.report.deviation = deviation / surface_.area;
  verdict.energy = 20 * steep / surface_.area + 0.03 * length / std::sqrt(surface_.area);
}

void LabelCheck::findCharts(const Labels& labels) {
  std::fill(chartOf_.begin(), chartOf_.end(), kNone);
  charts_.clear();
  for (Index first = 0; first < labels.size(); ++first) {
    if (chartOf_[first] != kNone) continue;
    const auto chart = static_cast<Index>(charts_.size());
    charts_.push_back({.first = first});
    chartOf_[first] = chart;
    stack_.push_back(first);
    while (!stack_.empty()) {
      const Index t = stack_.back();
      stack_.pop_back();
      for (Side side = 3 * t; side < 3 * t + 3; ++side) {
        const Index beyond = surface_.beyond(side);
        if (chartOf_[beyond] != kNone || labels[beyond] != labels[t]) continue;
        chartOf_[beyond] = chart;
        stack_.push_back(beyond);
      }
    }
  }
}

void LabelCheck::visitCorners(Verdict& verdict) {
  std::vector<Index> seen;
  for (const Side border : borders_) {
    const Index vertex = surface_.tails[border];
    if (borderCount_[vertex] < 3) continue;
    if (borderCount_[vertex] > 3) {
      verdict.places.push_back(Surface::triangleOf(border));
      seen.push_back(vertex);
    } else {
      ++verdict.report.corners;  // each is counted three times
    }
    const double cost = costs_.ofCorner(Surface::triangleOf(border));
    verdict.energy += cost / 3;
    if (cost > 0) verdict.places.push_back(Surface::triangleOf(border));
  }
  verdict.report.corners /= 3;
  std::sort(seen.begin(), seen.end());
  const auto bad = std::unique(seen.begin(), seen.end()) - seen.begin();
  verdict.report.badCorners = static_cast<std::uint64_t>(bad);
  verdict.report.corners += verdict.report.badCorners;
}

void LabelCheck::visitWindings(const Labels& labels, Verdict& verdict) {
  const std::vector<double>& spheres = windingOf_(labels);
  for (const Side side : sideAt_) {
    const double winding = std::abs(spheres[surface_.tails[side]]);
    if (winding == 0) continue;
    verdict.report.badCorners += static_cast<std::uint64_t>(winding);
    verdict.places.push_back(Surface::triangleOf(side));
  }
}

/// Collects the sides of a loop of borders, with the chart to their left.
void LabelCheck::walkLoop(const Labels& labels, Side first) {
  loop_.clear();
  Side side = first;
  do {
    isDone_[side] = true;
    loop_.push_back(side);
    side = Surface::next(side);
    while (labels[surface_.beyond(side)] == labels[Surface::triangleOf(side)]) {
      side = Surface::next(surface_.twins[side]);
    }
  } while (side != first);
}

/// Adds the pieces of the current loop; none if it has no corners.
void LabelCheck::addPieces() {
  const std::size_t before = pieces_.size();
  const std::size_t size = loop_.size();
  const auto chartBeyond = [&](std::size_t i) {
    return chartOf_[surface_.beyond(loop_[i % size])];
  };
  for (std::size_t i = 0; i < size; ++i) {
    if (borderCount_[surface_.tails[loop_[i]]] < 3) continue;
    if (pieces_.size() > before) pieces_.back().end = i;
    pieces_.push_back({.begin = i, .end = 0, .first = loop_[i]});
  }
  if (pieces_.size() == before) return;
  pieces_.back().end = pieces_[before].begin + size;
  for (std::size_t i = before; i < pieces_.size(); ++i) {
    pieces_[i].planes = {chartBeyond(pieces_[i].begin + size - 1), chartBeyond(pieces_[i].end)};
  }
}

/// Determines the axis of a piece, and the points where it turns back.
void LabelCheck::visitPiece(const Labels& labels, Piece& piece, Verdict& verdict) {
  const lattice::Direction here = labels[Surface::triangleOf(piece.first)];
  const lattice::Direction beyond = labels[surface_.beyond(piece.first)];
  piece.hasDirection = lattice::axisOf(here) != lattice::axisOf(beyond);
  if (!piece.hasDirection) return;
  const auto axis = static_cast<std::size_t>(3 - lattice::axisOf(here) - lattice::axisOf(beyond));
  // Each border is visited from both sides, but counts once.
  const bool counts =
      chartOf_[Surface::triangleOf(piece.first)] < chartOf_[surface_.beyond(piece.first)];
  const auto turnBack = [&](Side side) {
    if (!counts) return;
    ++verdict.report.turningPoints;
    verdict.places.push_back(Surface::triangleOf(side));
  };
  double x = 0;
  double extreme = 0;  // the farthest position in the direction of the run
  double low = 0;
  double high = 0;
  int run = 0;
  for (std::size_t i = piece.begin; i < piece.end; ++i) {
    const Side side = loop_[i % loop_.size()];
    x += surface_.lengths[side] * surface_.directions[side][axis];
    const double noise = kNoise * surface_.meanEdge;
    if (run == 0) {
      low = std::min(low, x);
      high = std::max(high, x);
      if (x - low > noise) run = 1;
      if (high - x > noise) run = -1;
      extreme = x;
    } else if (run * (x - extreme) >= 0) {
      extreme = x;
    } else if (std::abs(x - extreme) > noise) {
      run = -run;
      extreme = x;
      turnBack(side);
    }
  }
  if (piece.planes[0] == piece.planes[1]) turnBack(piece.first);
  piece.rise = x;
}

void LabelCheck::visitLoop(const Labels& labels, Verdict& verdict) {
  const Index triangle = Surface::triangleOf(loop_.front());
  const Index chart = chartOf_[triangle];
  ++charts_[chart].loops;
  const std::size_t before = pieces_.size();
  addPieces();
  const std::size_t corners = pieces_.size() - before;
  if (corners < 4) {
    // Graded, so that each step towards four corners pays off.
    verdict.report.badLoops += corners < 1 ? 3 : corners < 2 ? 2 : 1;
    charts_[chart].isBad = true;
    verdict.places.push_back(triangle);
    verdict.places.push_back(Surface::triangleOf(loop_[loop_.size() / 2]));
  }
  if (corners == 0) return;
  for (std::size_t i = before; i < pieces_.size(); ++i) visitPiece(labels, pieces_[i], verdict);
  loops_.push_back({chart, before, pieces_.size()});
}

/// Directs all pieces between two planes from the lower one to the upper one, or back, as most of
/// their length runs in space.
void LabelCheck::setDirections(const Labels& labels) {
  const auto key = [](const Piece& piece) { return std::minmax(piece.planes[0], piece.planes[1]); };
  std::vector<std::size_t> order(pieces_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(pieces_[a]) < key(pieces_[b]); });
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    double rise = 0;
    for (; end < order.size() && key(pieces_[order[end]]) == key(pieces_[order[begin]]); ++end) {
      const Piece& piece = pieces_[order[end]];
      rise += piece.planes[0] < piece.planes[1] ? piece.rise : -piece.rise;
    }
    for (; begin < end; ++begin) {
      Piece& piece = pieces_[order[begin]];
      if (!piece.hasDirection) continue;
      const int axis = 3 - lattice::axisOf(labels[Surface::triangleOf(piece.first)]) -
                       lattice::axisOf(labels[surface_.beyond(piece.first)]);
      const bool isUpwards = (piece.planes[0] < piece.planes[1]) == (rise > 0);
      piece.direction = lattice::direction(axis, isUpwards ? 1 : -1);
    }
  }
}

void LabelCheck::visitTurns(const Labels& labels, const Loop& loop, Verdict& verdict) {
  Chart& chart = charts_[loop.chart];
  int turns = 0;
  const Piece* before = &pieces_[loop.end - 1];
  for (std::size_t i = loop.begin; i < loop.end; ++i) {
    const Piece& piece = pieces_[i];
    if (before->hasDirection && piece.hasDirection &&
        lattice::axisOf(before->direction) != lattice::axisOf(piece.direction)) {
      const bool isLeft = lattice::cross(before->direction, piece.direction) == labels[chart.first];
      turns += isLeft ? 1 : -1;
    }
    before = &piece;
  }
  chart.turns += turns;
  if (loop.end - loop.begin < 4 || std::abs(turns) == 4) return;
  ++verdict.report.wrongTurns;
  chart.isBad = true;
  addPlaces(loop, verdict);
}

void LabelCheck::addPlaces(const Loop& loop, Verdict& verdict) const {
  for (std::size_t i = loop.begin; i < loop.end; ++i) {
    verdict.places.push_back(Surface::triangleOf(pieces_[i].first));
  }
}

/// Corners of three charts: seen from outside, the normals are a right-handed or left-handed
/// system. If right-handed, either all or none of the edges run along their axis to the inside of
/// the polycube; if left-handed, one or two.
void LabelCheck::visitRoom(const Labels& labels, Verdict& verdict) {
  struct Edge {
    Index corner;
    Index triangle;
    bool isRightHanded;
    bool leavesInside;
  };
  std::vector<Edge> edges;
  for (const Piece& piece : pieces_) {
    const Index corner = surface_.tails[piece.first];
    if (borderCount_[corner] != 3 || !piece.hasDirection) continue;
    const Index left = Surface::triangleOf(piece.first);
    const lattice::Direction normal =
        lattice::cross(labels[surface_.beyond(piece.first)], labels[left]);
    const lattice::Direction third = labels[charts_[piece.planes[0]].first];
    edges.push_back({corner, left, normal == third, piece.direction == lattice::opposite(third)});
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.corner < b.corner; });
  for (std::size_t i = 0; i + 3 <= edges.size();) {
    if (edges[i].corner != edges[i + 2].corner) {  // opposite labels meet there
      ++i;
      continue;
    }
    const int inside =
        edges[i].leavesInside + edges[i + 1].leavesInside + edges[i + 2].leavesInside;
    if (edges[i].isRightHanded != (inside % 3 == 0)) {
      ++verdict.report.badCorners;
      verdict.places.push_back(edges[i].triangle);
    }
    i += 3;
  }
}

/// Whether edges that lead upwards connect one plane to another one above.
bool LabelCheck::isBelow(Index low, Index high) {
  std::vector<bool> isSeen(charts_.size());
  stack_ = {low};
  while (!stack_.empty()) {
    const Index at = stack_.back();
    stack_.pop_back();
    for (const Index above : charts_[at].above) {
      if (above == high) {
        stack_.clear();
        return true;
      }
      if (!isSeen[above]) stack_.push_back(above);
      isSeen[above] = true;
    }
  }
  return false;
}

/// Requires each edge of a face to have an opposite edge across the face, in a plane that may lie
/// beyond it. If a hole and the border around it adjoin the same chart, for example, there is no
/// width in between.
void LabelCheck::visitWidths(const Labels& labels, Verdict& verdict) {
  for (const Piece& piece : pieces_) {
    if (!piece.hasDirection) continue;
    const auto& [tail, head] = piece.planes;
    const bool isUpwards = lattice::signOf(piece.direction) > 0;
    charts_[isUpwards ? tail : head].above.push_back(isUpwards ? head : tail);
  }
  std::vector<std::vector<const Piece*>> around(charts_.size());
  for (const Piece& piece : pieces_) {
    around[chartOf_[Surface::triangleOf(piece.first)]].push_back(&piece);
  }
  for (const auto& pieces : around) {
    const auto inwards = [&](const Piece& piece) {
      return lattice::cross(labels[Surface::triangleOf(piece.first)], piece.direction);
    };
    const auto mayFace = [&](const Piece& one, const Piece& other) {
      if (inwards(one) != lattice::opposite(inwards(other))) return false;
      const Index here = chartOf_[surface_.beyond(one.first)];
      const Index there = chartOf_[surface_.beyond(other.first)];
      if (here == there) return false;
      return lattice::signOf(inwards(one)) > 0 ? !isBelow(there, here) : !isBelow(here, there);
    };
    const auto hasWidth = [&](const Piece* one) {
      return std::any_of(pieces.begin(), pieces.end(),
                         [&](const Piece* other) { return mayFace(*one, *other); });
    };
    if (std::all_of(pieces.begin(), pieces.end(), hasWidth)) continue;
    ++verdict.report.flatCharts;
    for (const Piece* piece : pieces) {
      verdict.places.push_back(Surface::triangleOf(piece->first));
    }
  }
}

/// Twice the Euler characteristic. Along borders, there are as many vertices as edges.
void LabelCheck::setCharacteristics() {
  for (const Index chart : chartOf_) --charts_[chart].twiceCharacteristic;
  for (const Side border : borders_) {
    ++charts_[chartOf_[Surface::triangleOf(border)]].twiceCharacteristic;
  }
  for (const Side side : sideAt_) {
    if (borderCount_[surface_.tails[side]] > 0) continue;
    charts_[chartOf_[Surface::triangleOf(side)]].twiceCharacteristic += 2;
  }
}

void LabelCheck::visitCharts(Verdict& verdict) const {
  for (Index i = 0; i < charts_.size(); ++i) {
    const Chart& chart = charts_[i];
    const std::int64_t handles = (2 * (2 - chart.loops) - chart.twiceCharacteristic) / 4;
    if (chart.loops == 0) {
      verdict.report.badLoops += 3;  // a closed surface with a single label
      verdict.places.push_back(chart.first);
    } else if (handles > 0) {
      verdict.report.wrongTurns += static_cast<std::uint64_t>(handles);
      for (Index t = 0; t < chartOf_.size(); ++t) {
        if (chartOf_[t] == i) verdict.places.push_back(t);
      }
    } else if (!chart.isBad && chart.turns != 4 * (2 - chart.loops)) {
      ++verdict.report.wrongTurns;
      for (const Loop& loop : loops_) {
        if (loop.chart == i) addPlaces(loop, verdict);
      }
    }
  }
}

Verdict LabelCheck::operator()(const Labels& labels) {
  reset();
  Verdict verdict;
  visitTriangles(labels, verdict);
  findCharts(labels);
  verdict.report.charts = charts_.size();
  visitCorners(verdict);
  visitWindings(labels, verdict);
  for (const Side border : borders_) {
    if (isDone_[border]) continue;
    walkLoop(labels, border);
    visitLoop(labels, verdict);
  }
  setDirections(labels);
  for (const Loop& loop : loops_) visitTurns(labels, loop, verdict);
  visitRoom(labels, verdict);
  setCharacteristics();
  visitCharts(verdict);
  if (verdict.report.isValid()) visitWidths(labels, verdict);
  verdict.energy = energyOf(verdict.report, verdict.energy);
  return verdict;
}

}  // namespace hexhex::shape
