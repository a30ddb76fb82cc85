#include <algorithm>
#include <cmath>
#include <utility>

#include <shape/label_search.hpp>

#include <base/sorted.hpp>

namespace hexhex::shape {

namespace {

/// Once labels are valid, moves up to this total improve shape: shorter borders, smaller angles
/// between triangles and labels.
constexpr std::uint64_t kMovesIfValid = 300;
/// Interval of moves at which the search returns to the best labels so far.
constexpr std::uint64_t kMovesUntilReturn = 400;
constexpr std::size_t kLargestDisk = 3000;
/// Radii of disks, in mean edges.
constexpr double kLeastRadius = 1.5;
constexpr double kLargestRadius = 25;
/// Initial temperature. A bad loop or corner contributes 1 to the energy.
constexpr double kTemperature = 0.15;

/// Draws from an interval of positive numbers, uniformly on a logarithmic scale.
double drawBetween(double low, double high, Random& random) {
  return low * std::exp(random.share() * std::log(high / low));
}

bool isValid(const Verdict& verdict) { return verdict.report.isValid(); }

}  // namespace

LabelSearch::LabelSearch(const Surface& surface, const LabelCosts& costs, Random random)
    : surface_(surface),
      check_(surface, costs),
      expansion_(surface, costs),
      random_(random),
      stamps_(surface.triangleCount()) {}

CheckedLabels LabelSearch::improve(const Labels& start, std::uint64_t mostMoves, Context& context) {
  CheckedLabels current = {start, check_(start)};
  CheckedLabels best = current;
  std::uint64_t moves = 0;
  while (moves < (isValid(best.verdict) ? kMovesIfValid : mostMoves)) {
    context.throwIfCancelled();
    if (++moves % kMovesUntilReturn == 0) current = best;
    Labels labels = current.labels;
    move(labels, current.verdict);
    if (labels == current.labels) continue;
    const double rest = 1 - static_cast<double>(moves) / static_cast<double>(mostMoves);
    const double allowed =
        random_.share() < 0.3 ? -kTemperature * rest * rest * std::log(1 - random_.share()) : 0;
    Verdict verdict = check_(labels);
    if (verdict.energy >= current.verdict.energy + allowed) continue;
    current.labels = std::move(labels);
    current.verdict = std::move(verdict);
    // Valid labels beat invalid ones, whatever their energy.
    const bool gains = isValid(current.verdict) == isValid(best.verdict)
                           ? current.verdict.energy < best.verdict.energy
                           : isValid(current.verdict);
    if (gains) best = current;
  }
  best.moves = moves;
  return best;
}

bool LabelSearch::mark(Index triangle) {
  if (stamps_[triangle] == stamp_) return false;
  stamps_[triangle] = stamp_;
  return true;
}

std::vector<Index> LabelSearch::disk(Index centre, double radius) {
  unmarkAll();
  mark(centre);
  std::vector<Index> disk = {centre};
  for (std::size_t i = 0; i < disk.size() && disk.size() < kLargestDisk; ++i) {
    for (Side side = 3 * disk[i]; side < 3 * disk[i] + 3; ++side) {
      const Index beyond = surface_.beyond(side);
      const Vec3 away = minus(surface_.centres[beyond], surface_.centres[centre]);
      if (length(away) < radius && mark(beyond)) disk.push_back(beyond);
    }
  }
  return disk;
}

/// Draws a triangle at a fault or at a border, or close to one.
Index LabelSearch::drawPlace(const Labels& labels, const Verdict& verdict) {
  constexpr int kTries = 60;  // to find a border
  Index place = 0;
  if (!verdict.places.empty() && random_.share() < 0.85) {
    place = verdict.places[random_.below(verdict.places.size())];
  } else {
    const auto isAtBorder = [&](Index t) {
      return labels[surface_.beyond(3 * t)] != labels[t] ||
             labels[surface_.beyond(3 * t + 1)] != labels[t] ||
             labels[surface_.beyond(3 * t + 2)] != labels[t];
    };
    for (int i = 0; i < kTries; ++i) {
      place = static_cast<Index>(random_.below(labels.size()));
      if (isAtBorder(place)) break;
    }
  }
  if (random_.share() >= 0.3) return place;
  const std::vector<Index> near = disk(place, 2.5 * surface_.meanEdge);
  return near[random_.below(near.size())];
}

/// Draws a label; those close to the normal are more likely.
lattice::Direction LabelSearch::drawLabel(Index triangle) {
  const auto weight = [&](lattice::Direction label) {
    return std::max(0.03, 0.35 + cosine(surface_.normals[triangle], label));
  };
  double sum = 0;
  for (lattice::Direction label = 0; label < lattice::kDirections; ++label) sum += weight(label);
  double left = random_.share() * sum;
  for (lattice::Direction label = 0; label < lattice::kDirections; ++label) {
    left -= weight(label);
    if (left <= 0) return label;
  }
  return lattice::kDirections - 1;
}

Compactness LabelSearch::drawCompactness() {
  const double weight = drawBetween(0.3, 12, random_);
  return {weight, random_.share() < 0.5 ? 0 : drawBetween(0.5, 10, random_)};
}

/// Applies a random move to the labels.
void LabelSearch::move(Labels& labels, const Verdict& verdict) {
  const Index place = drawPlace(labels, verdict);
  const double largest = std::max(
      2 * kLeastRadius, std::min(kLargestRadius, 0.4 * surface_.diagonal / surface_.meanEdge));
  const double radius = surface_.meanEdge * drawBetween(kLeastRadius, largest, random_);
  const double kind = random_.share();
  if (kind < 0.2) {
    const lattice::Direction label = drawLabel(place);
    for (const Index t : disk(place, 0.5 * radius)) labels[t] = label;
  } else if (kind < 0.32) {
    changeChart(labels, place);
  } else {
    cutAgain(labels, place, radius, (kind - 0.32) / 0.68);
  }
}

/// Relabels a whole chart, with the label of a neighbour or by a cut that forbids its own label.
void LabelSearch::changeChart(Labels& labels, Index place) {
  unmarkAll();
  mark(place);
  std::vector<Index> chart = {place};
  std::vector<lattice::Direction> beside;
  for (std::size_t i = 0; i < chart.size(); ++i) {
    for (Side side = 3 * chart[i]; side < 3 * chart[i] + 3; ++side) {
      const Index beyond = surface_.beyond(side);
      if (labels[beyond] != labels[place]) {
        beside.push_back(labels[beyond]);
      } else if (mark(beyond)) {
        chart.push_back(beyond);
      }
    }
  }
  if (beside.empty() || chart.size() > labels.size() / 4) return;
  sortUnique(beside);
  const lattice::Direction label = beside[random_.below(beside.size())];
  if (random_.share() < 0.6) {
    for (const Index t : chart) labels[t] = label;
  } else {
    cutWithout(labels, std::move(chart));
  }
}

/// Cuts a chart and a few rings around it anew, without the chart's label.
/// @param chart  must be marked
void LabelSearch::cutWithout(Labels& labels, std::vector<Index> chart) {
  const std::size_t inside = chart.size();
  Region region = {std::move(chart), {}};
  std::size_t begin = 0;
  for (std::uint64_t rings = 1 + random_.below(3); rings > 0; --rings) {
    const std::size_t end = region.triangles.size();
    for (; begin < end; ++begin) {
      const Side first = 3 * region.triangles[begin];
      for (Side side = first; side < first + 3; ++side) {
        if (mark(surface_.beyond(side))) region.triangles.push_back(surface_.beyond(side));
      }
    }
  }
  region.forbidden.resize(region.triangles.size());
  const auto own = static_cast<std::uint8_t>(1U << labels[region.triangles.front()]);
  std::fill_n(region.forbidden.begin(), inside, own);
  expansion_.run(labels, region, drawCompactness(), 2, random_);
}

/// Cuts a disk anew.
/// @param kind  0 to 1: low values set no conditions, medium ones force a label near the centre,
///              high ones forbid one there
void LabelSearch::cutAgain(Labels& labels, Index place, double radius, double kind) {
  Region region = {disk(place, radius), {}};
  if (kind > 0.26) {
    const bool forces = kind < 0.7;
    const lattice::Direction label = forces ? drawLabel(place) : labels[place];
    const unsigned only = 1U << label;
    const double share = forces ? 0.15 + 0.5 * random_.share() : 0.3 + 0.6 * random_.share();
    for (const Index t : region.triangles) {
      const double distance = length(minus(surface_.centres[t], surface_.centres[place]));
      const unsigned forbidden = distance >= share * radius ? 0 : forces ? ~only & 63U : only;
      region.forbidden.push_back(static_cast<std::uint8_t>(forbidden));
    }
  }
  expansion_.run(labels, region, drawCompactness(), 2, random_);
}

}  // namespace hexhex::shape
