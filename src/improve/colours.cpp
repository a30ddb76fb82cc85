#include <algorithm>

#include <improve/colours.hpp>

namespace hexhex::improvement {

Colours::Colours(const CellPoints& mesh) : colourOf_(mesh.pointCount) {
  // Each vertex gets the first colour that none before it has around.
  std::vector<Index> takenBy;  // per colour: the last vertex with a neighbour of it
  for (Index v = 0; v < mesh.pointCount; ++v) {
    for (const Index cell : mesh.around(v)) {
      for (const Index other : mesh.of(cell)) {
        if (other < v) takenBy[colourOf_[other]] = v;
      }
    }
    const auto colour = static_cast<std::size_t>(
        std::find_if(takenBy.begin(), takenBy.end(), [v](Index by) { return by != v; }) -
        takenBy.begin());
    if (colour == takenBy.size()) takenBy.push_back(kNone);
    colourOf_[v] = static_cast<std::uint16_t>(colour);
  }
  count_ = takenBy.size();
}

Colours::Groups Colours::groupsOf(std::span<const Index> vertices) const {
  Groups groups;
  groups.ends.resize(count_);
  for (const Index v : vertices) ++groups.ends[colourOf_[v]];
  std::vector<std::size_t> next(count_);
  for (std::size_t c = 1; c < count_; ++c) {
    next[c] = groups.ends[c - 1];
    groups.ends[c] += groups.ends[c - 1];
  }
  groups.vertices.resize(vertices.size());
  for (const Index v : vertices) groups.vertices[next[colourOf_[v]]++] = v;
  return groups;
}

}  // namespace hexhex::improvement
