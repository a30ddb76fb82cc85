#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include <shape/labels.hpp>

#include <base/parallel.hpp>

namespace hexhex::shape {

namespace {

/// From labels that follow the surface closely to few large charts.
constexpr std::array<Compactness, 4> kStarts = {{{1, 0}, {3, 0}, {8, 1}, {20, 1}}};
constexpr int kSweeps = 3;
/// Number of concurrent searches per round, each from one of the best labels so far. A later round
/// runs only if no labels are valid.
constexpr std::size_t kLabelSearches = 2;
constexpr int kLabelRounds = 2;
/// Limits of the number of moves of a search.
constexpr double kFewestMoves = 400;
constexpr double kMostMoves = 1500;
/// Cost of a move per triangle, relative to a solver step per tet, and the share of the remaining
/// work available to all searches.
constexpr double kWorkOfMove = 0.5;
constexpr double kShareOfMoves = 0.5;

Labels nearestLabels(const Surface& surface) {
  constexpr double kTie = 1e-9;  // ties go to the first axis
  Labels labels(surface.triangleCount());
  for (Index t = 0; t < labels.size(); ++t) {
    for (lattice::Direction label = 1; label < lattice::kDirections; ++label) {
      const Vec3& normal = surface.normals[t];
      if (cosine(normal, label) > cosine(normal, labels[t]) + kTie) labels[t] = label;
    }
  }
  return labels;
}

/// Sorts valid labels first, then by energy, and removes duplicates.
void sortByMerit(std::vector<CheckedLabels>& all) {
  const auto isBetter = [](const CheckedLabels& a, const CheckedLabels& b) {
    const bool isValid = a.verdict.report.isValid();
    if (isValid != b.verdict.report.isValid()) return isValid;
    return a.verdict.energy < b.verdict.energy;
  };
  std::stable_sort(all.begin(), all.end(), isBetter);
  const auto isSame = [](const CheckedLabels& a, const CheckedLabels& b) {
    return a.labels == b.labels;
  };
  all.erase(std::unique(all.begin(), all.end(), isSame), all.end());
}

std::vector<CheckedLabels> cutAll(const Surface& surface, const LabelCosts& costs,
                                  std::uint64_t seed, Stage& stage) {
  Region all;
  all.triangles.resize(surface.triangleCount());
  std::iota(all.triangles.begin(), all.triangles.end(), Index{0});
  std::vector<CheckedLabels> starts(kStarts.size());
  parallelFor(stage, kStarts.size(), 1, [&](std::size_t i) {
    Random random(seed, 2 + i);
    starts[i].labels = nearestLabels(surface);
    Expansion(surface, costs).run(starts[i].labels, all, kStarts[i], kSweeps, random);
    starts[i].verdict = LabelCheck(surface, costs)(starts[i].labels);
  });
  return starts;
}

}  // namespace

CheckedLabels labelsOf(const Surface& surface, const LabelCosts& costs, std::uint64_t seed,
                       double& workLeft, Stage& stage) {
  stage.setTotal(kStarts.size() + kLabelSearches * kLabelRounds);
  std::vector<CheckedLabels> found = cutAll(surface, costs, seed, stage);
  sortByMerit(found);
  const double workOfMove = kWorkOfMove * static_cast<double>(surface.triangleCount());
  const double affordable = kShareOfMoves * workLeft / (workOfMove * kLabelSearches * kLabelRounds);
  const auto mostMoves =
      static_cast<std::uint64_t>(std::clamp(affordable, kFewestMoves, kMostMoves));
  for (std::size_t round = 0; round < kLabelRounds; ++round) {
    const std::size_t count = std::min(kLabelSearches, found.size());
    std::vector<CheckedLabels> better(count);
    parallelFor(stage, count, 1, [&](std::size_t i) {
      const Random random(seed, 16 + round * kLabelSearches + i);
      LabelSearch search(surface, costs, random);
      better[i] = search.improve(found[i].labels, mostMoves, stage.context());
    });
    for (const CheckedLabels& each : better) {
      workLeft -= workOfMove * static_cast<double>(each.moves);
    }
    found.insert(found.end(), better.begin(), better.end());
    sortByMerit(found);
    if (found.front().verdict.report.isValid()) break;
  }
  return found.front();
}

}  // namespace hexhex::shape
