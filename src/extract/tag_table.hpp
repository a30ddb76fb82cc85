// Tagged edges or triangles of a tet mesh, found by their vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// @tparam n  vertices of a simplex: 2 or 3
template <std::size_t n>
class TagTable {
 public:
  using Simplex = std::array<Index, n>;

  /// @param features  with vertices below `points`; those with tag 0 are left out
  template <class Feature>
  TagTable(std::size_t points, std::span<const Feature> features) {
    for (const Feature& feature : features) {
      if (feature.tag != 0) entries_.push_back({sorted(feature.vertices), feature.tag});
    }
    if (entries_.empty()) return;
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.simplex != b.simplex ? a.simplex < b.simplex : a.tag < b.tag;
    });
    begin_.assign(points + 1, 0);
    for (const Entry& entry : entries_) ++begin_[std::size_t{entry.simplex[0]} + 1];
    for (std::size_t i = 0; i < points; ++i) begin_[i + 1] += begin_[i];
  }

  /// The tag of the simplex of a tet, 0 if it has none or has another number of corners.
  [[nodiscard]] std::int32_t find(const Tet& tet, CornerMask simplex) const {
    if (entries_.empty() || dimension(simplex) != static_cast<int>(n) - 1) return 0;
    Simplex wanted{};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (contains(simplex, static_cast<int>(i))) wanted[k++] = tet[i];
    }
    wanted = sorted(wanted);
    for (std::size_t i = begin_[wanted[0]]; i < begin_[std::size_t{wanted[0]} + 1]; ++i) {
      if (entries_[i].simplex == wanted) return entries_[i].tag;
    }
    return 0;
  }

  /// @throws Error InvalidArgument if a simplex has two tags
  void requireOne() const {
    for (std::size_t i = 1; i < entries_.size(); ++i) {
      const Entry& a = entries_[i - 1];
      const Entry& b = entries_[i];
      if (a.simplex != b.simplex || a.tag == b.tag) continue;
      std::string vertices;
      for (const Index v : a.simplex) {
        if (!vertices.empty()) vertices += '-';
        vertices += std::to_string(v);
      }
      throw Error(ErrorCode::InvalidArgument, std::string(n == 2 ? "The edge " : "The triangle ") +
                                                  vertices + " is tagged twice, " +
                                                  std::to_string(a.tag) + " and " +
                                                  std::to_string(b.tag) + ". Give it one tag.");
    }
  }

 private:
  struct Entry {
    Simplex simplex;
    std::int32_t tag;
  };
  static Simplex sorted(Simplex simplex) {
    std::sort(simplex.begin(), simplex.end());
    return simplex;
  }

  std::vector<Entry> entries_;      ///< ascending
  std::vector<std::size_t> begin_;  ///< per vertex (+1): the entries that it is the smallest of
};

}  // namespace hexhex
