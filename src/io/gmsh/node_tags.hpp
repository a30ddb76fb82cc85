// Nodes that files name by tags of their own choice instead of by their place.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hexhex/types.hpp>

namespace hexhex {

/// Finds nodes by their tags.
class NodeTags {
 public:
  NodeTags() = default;
  /// @param tags  of the nodes in their order; fewer than kNone
  explicit NodeTags(const Array<std::uint64_t>& tags) : count_(tags.size()) {
    if (tags.empty()) return;
    first_ = tags[0];
    std::size_t i = 0;
    while (i < tags.size() && tags[i] == first_ + i) ++i;
    if (i < tags.size()) sortTags(tags);
  }

  /// The node with a tag, or kNone.
  [[nodiscard]] Index find(std::uint64_t tag) const {
    if (sorted_.empty()) {
      return tag - first_ < count_ ? static_cast<Index>(tag - first_) : kNone;
    }
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), Entry{tag, 0});
    return found == sorted_.end() || found->first != tag ? kNone : found->second;
  }

  /// A node whose tag an earlier node has, too; kNone if there is none.
  [[nodiscard]] Index repeated() const {
    for (std::size_t i = 1; i < sorted_.size(); ++i) {
      if (sorted_[i].first == sorted_[i - 1].first) return sorted_[i].second;
    }
    return kNone;
  }

 private:
  using Entry = std::pair<std::uint64_t, Index>;

  void sortTags(const Array<std::uint64_t>& tags) {
    sorted_.resize(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) sorted_[i] = {tags[i], static_cast<Index>(i)};
    std::sort(sorted_.begin(), sorted_.end());
  }

  // The usual case needs no table: consecutive tags from first_ on.
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
  Array<Entry> sorted_;
};

}  // namespace hexhex
