// Transfinite interpolation of the nodes of a cell (Gordon and Hall, 1973): inside edges between
// corners, inside faces between edges, inside the cell between faces.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace hexhex::curved {

/// A node inside an edge, a face or the cell, and the weights of the nodes from which it is
/// blended.
struct BlendedNode {
  std::size_t node = 0;
  std::vector<std::pair<std::size_t, double>> weights = {};
};

/// The nodes of one cell, by the element they are inside of.
struct BlendedNodes {
  std::vector<BlendedNode> ofEdges = {};
  std::vector<BlendedNode> ofFaces = {};
  std::vector<BlendedNode> ofCell = {};

  explicit BlendedNodes(int order) {
    const auto last = static_cast<std::size_t>(order);
    const std::size_t n = last + 1;
    for (std::size_t node = 0; node < n * n * n; ++node) {
      const std::array<std::size_t, 3> place = {node % n, node / n % n, node / n / n};
      std::vector<std::size_t> axes;
      for (std::size_t k = 0; k < 3; ++k) {
        if (place[k] > 0 && place[k] < last) axes.push_back(k);
      }
      if (axes.empty()) continue;
      auto& list = axes.size() == 1 ? ofEdges : (axes.size() == 2 ? ofFaces : ofCell);
      list.push_back(blended(node, place, axes, last));
    }
  }

  /// In the order of blending.
  [[nodiscard]] std::array<const std::vector<BlendedNode>*, 3> all() const {
    return {&ofEdges, &ofFaces, &ofCell};
  }

 private:
  /// The Boolean sum of linear interpolations along the axes: that along each axis, minus that
  /// along each two, and so on. Per axis, a choice is to stay or to go to the first or second end.
  static BlendedNode blended(std::size_t node, const std::array<std::size_t, 3>& place,
                             const std::vector<std::size_t>& axes, std::size_t last) {
    const std::array<std::size_t, 3> strides = {1, last + 1, (last + 1) * (last + 1)};
    BlendedNode result = {node};
    constexpr std::array<std::size_t, 4> kChoices = {1, 3, 9, 27};
    for (std::size_t choice = 1; choice < kChoices[axes.size()]; ++choice) {
      std::size_t from = node;
      double weight = -1;
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::size_t k = axes[i];
        const std::size_t end = choice / kChoices[i] % 3;
        if (end == 0) continue;
        const double share = static_cast<double>(place[k]) / static_cast<double>(last);
        weight *= end == 1 ? share - 1 : -share;
        from -= place[k] * strides[k];
        if (end == 2) from += last * strides[k];
      }
      result.weights.emplace_back(from, weight);
    }
    return result;
  }
};

}  // namespace hexhex::curved
