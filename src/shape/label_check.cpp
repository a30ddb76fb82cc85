#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <shape/label_check.hpp>

namespace hexhex::shape {

namespace {

/// A border turns back where it does so by more than that, in mean edges: less is the mesh's noise.
constexpr double kNoise = 0.7;
/// Beyond this cosine a triangle is nearly perpendicular to its label: 87 degrees.
constexpr double kPerpendicular = 0.05;

/// @param shape  that of steep triangles and of borders
double energyOf(const LabelReport& report, double shape) {
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  double energy = report.deviation + shape;
  energy += count(report.badLoops + report.badCorners) + 0.3 * count(report.turningPoints) +
            0.7 * count(report.wrongTurns);
  if (report.oppositeEdges > 0) {
    energy += std::floor(1 + count(report.oppositeEdges) / 20) + 0.02 * count(report.oppositeEdges);
  }
  return energy;
}

}  // namespace

LabelCheck::LabelCheck(const Surface& surface, const LabelCosts& costs)
    : surface_(surface),
      costs_(costs),
      chartOf_(surface.triangleCount()),
      borderCount_(surface.pointCount),
      isDone_(surface.tails.size()) {}

void LabelCheck::reset() {
  for (const Side border : borders_) {
    borderCount_[surface_.tails[border]] = 0;
    isDone_[border] = false;
  }
  borders_.clear();
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
      ++verdict.report.corners;  // three times
    }
  }
  verdict.report.corners /= 3;
  std::sort(seen.begin(), seen.end());
  const auto bad = std::unique(seen.begin(), seen.end()) - seen.begin();
  verdict.report.badCorners = static_cast<std::uint64_t>(bad);
  verdict.report.corners += verdict.report.badCorners;
}

/// The sides of a chart's border, with the chart to their left.
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

std::vector<LabelCheck::Piece> LabelCheck::pieces() const {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < loop_.size(); ++i) {
    if (borderCount_[surface_.tails[loop_[i]]] < 3) continue;
    if (!pieces.empty()) pieces.back().end = i;
    pieces.push_back({i, 0});
  }
  if (pieces.empty()) return {{0, loop_.size()}};
  pieces.back().end = pieces.front().begin + loop_.size();
  return pieces;
}

/// @return where it runs, of length 1; 0 between opposite labels
Vec3 LabelCheck::visitPiece(const Labels& labels, const Piece& piece, Verdict& verdict) {
  const Side first = loop_[piece.begin];
  const lattice::Direction here = labels[Surface::triangleOf(first)];
  const lattice::Direction beyond = labels[surface_.beyond(first)];
  if (lattice::axisOf(here) == lattice::axisOf(beyond)) return {};
  const auto axis = static_cast<std::size_t>(3 - lattice::axisOf(here) - lattice::axisOf(beyond));
  // The same border is seen from both sides.
  const bool counts = chartOf_[Surface::triangleOf(first)] < chartOf_[surface_.beyond(first)];
  double x = 0;
  double extreme = 0;  // farthest in the direction of the run, as long as there is one
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
      if (!counts) continue;
      ++verdict.report.turningPoints;
      verdict.places.push_back(Surface::triangleOf(side));
    }
  }
  Vec3 direction{};
  direction[axis] = x > 0 ? 1 : -1;
  return direction;
}

void LabelCheck::visitLoop(const Labels& labels, Verdict& verdict) {
  const Index triangle = Surface::triangleOf(loop_.front());
  Chart& chart = charts_[chartOf_[triangle]];
  ++chart.loops;
  const std::vector<Piece> all = pieces();
  const bool hasCorners = borderCount_[surface_.tails[loop_[all.front().begin]]] >= 3;
  const std::size_t corners = hasCorners ? all.size() : 0;
  if (corners < 4) {
    // The fewer, the worse: a step towards four is to pay off.
    verdict.report.badLoops += corners < 1 ? 3 : corners < 2 ? 2 : 1;
    chart.isBad = true;
    verdict.places.push_back(triangle);
    verdict.places.push_back(Surface::triangleOf(loop_[loop_.size() / 2]));
  }
  if (corners == 0) return;
  std::vector<Vec3> directions;
  directions.reserve(all.size());
  for (const Piece& piece : all) directions.push_back(visitPiece(labels, piece, verdict));
  int turns = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Vec3& before = directions[(i + all.size() - 1) % all.size()];
    turns += static_cast<int>(std::lround(cosine(cross(before, directions[i]), labels[triangle])));
  }
  chart.turns += turns;
  if (corners < 4 || std::abs(turns) == 4) return;
  ++verdict.report.wrongTurns;
  chart.isBad = true;
  for (const Piece& piece : all) verdict.places.push_back(Surface::triangleOf(loop_[piece.begin]));
}

void LabelCheck::visitCharts(Verdict& verdict) const {
  for (const Chart& chart : charts_) {
    if (chart.loops == 0) {
      verdict.report.badLoops += 3;  // a closed surface that faces one way
      verdict.places.push_back(chart.first);
    } else if (!chart.isBad && chart.turns != 4 * (2 - chart.loops)) {
      ++verdict.report.wrongTurns;
      verdict.places.push_back(chart.first);
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
  for (const Side border : borders_) {
    if (isDone_[border]) continue;
    walkLoop(labels, border);
    visitLoop(labels, verdict);
  }
  visitCharts(verdict);
  verdict.energy = energyOf(verdict.report, verdict.energy);
  return verdict;
}

}  // namespace hexhex::shape
