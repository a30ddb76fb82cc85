#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

#include <quantize/sorted_tets.hpp>

namespace hexhex::quantization {

namespace {

/// Moves the smallest vertex of a tet to the front, and then the smallest of the others.
void sortCorners(Tet& tet, TetParameters& u) {
  // Two swaps each, so that the permutation is even.
  const auto swap = [&](std::size_t a, std::size_t b) {
    std::swap(tet[a], tet[b]);
    std::swap(u[a], u[b]);
  };
  const auto first =
      static_cast<std::size_t>(std::min_element(tet.begin(), tet.end()) - tet.begin());
  if (first != 0) {
    swap(0, first);
    swap(first == 1 ? 2 : 1, first == 3 ? 2 : 3);
  }
  while (tet[1] > tet[2] || tet[1] > tet[3]) {
    swap(1, 2);
    swap(2, 3);
  }
}

}  // namespace

TetMap inCanonicalOrder(const TetMapView& map, std::vector<Index>& order) {
  const auto key = [&map](Index t) {
    Tet tet = map.tets[t];
    std::sort(tet.begin(), tet.end());
    return tet;
  };
  order.resize(map.tets.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  TetMap sorted;
  sorted.points.assign(map.points.begin(), map.points.end());
  for (const Index t : order) {
    Tet tet = map.tets[t];
    TetParameters u = map.parameters[t];
    sortCorners(tet, u);
    sorted.tets.push_back(tet);
    sorted.parameters.push_back(u);
    if (!map.regions.empty()) sorted.regions.push_back(map.regions[t]);
  }
  sorted.features = map.features.copy();
  return sorted;
}

Error inCallersTerms(const Error& error, const TetMapView& map, const std::vector<Index>& order) {
  Place place = error.place();
  const bool isFace = place.kind == PlaceKind::Face;
  if (!(isFace || place.kind == PlaceKind::Tet) || place.index >= order.size()) return error;
  place.index = order[place.index];
  if (isFace) {
    const Tet& callers = map.tets[place.index];
    Tet sorted = callers;
    TetParameters unused{};
    sortCorners(sorted, unused);
    const auto corner = std::find(callers.begin(), callers.end(), sorted[place.second]);
    place.second = static_cast<std::uint64_t>(corner - callers.begin());
  }
  std::string text = error.what();
  const std::string said = " at " + toString(error.place());
  if (const std::size_t at = text.find(said); at != std::string::npos) {
    text.replace(at, said.size(), " at " + toString(place));
  }
  return {error.code(), text, place};
}

void restoreOrder(const std::vector<Index>& order, TetMap& map) {
  const auto restore = [&order](auto& values) {
    auto sorted = values;
    for (std::size_t i = 0; i < order.size(); ++i) values[order[i]] = sorted[i];
  };
  restore(map.tets);
  restore(map.parameters);
  if (!map.regions.empty()) restore(map.regions);
}

}  // namespace hexhex::quantization
