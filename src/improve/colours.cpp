#include <algorithm>

#include <improve/colours.hpp>

namespace hexhex {

Colours::Colours(const CellPoints& mesh, std::span<const Index> vertices) {
  // Each vertex gets the first colour that no neighbour has.
  std::vector<Index> colourOf(mesh.pointCount, kNone);
  std::vector<std::size_t> sizes;
  std::vector<Index> takenBy;  // per colour: the last vertex with a neighbour of it
  for (const Index v : vertices) {
    for (const Index cell : mesh.around(v)) {
      for (const Index other : mesh.of(cell)) {
        if (colourOf[other] != kNone) takenBy[colourOf[other]] = v;
      }
    }
    const auto colour = static_cast<std::size_t>(
        std::find_if(takenBy.begin(), takenBy.end(), [v](Index by) { return by != v; }) -
        takenBy.begin());
    if (colour == sizes.size()) {
      sizes.push_back(0);
      takenBy.push_back(kNone);
    }
    ++sizes[colour];
    colourOf[v] = static_cast<Index>(colour);
  }
  ends_ = sizes;
  std::vector<std::size_t> next(sizes.size());
  for (std::size_t c = 1; c < ends_.size(); ++c) {
    next[c] = ends_[c - 1];
    ends_[c] += ends_[c - 1];
  }
  vertices_.resize(vertices.size());
  for (const Index v : vertices) vertices_[next[colourOf[v]]++] = v;
}

}  // namespace hexhex
