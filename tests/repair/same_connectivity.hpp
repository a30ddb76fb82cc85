// Whether two hexahedral meshes are the same but for numbering and positions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::test {

/// Maps one mesh onto the other, from one cell on and then across faces.
class Isomorphism {
 public:
  Isomorphism(const HexMesh& a, const HexMesh& b)
      : a_(a), b_(b), facesA_(collectFaces(a)), facesB_(collectFaces(b)) {}

  /// Tries all places for the first cell; those whose corners are in the same positions first.
  bool exists() {
    if (a_.cells.size() != b_.cells.size() || a_.points.size() != b_.points.size()) return false;
    if (a_.cells.empty()) return true;
    const std::optional<std::pair<std::size_t, Hex>> anchor = findAnchor();
    if (anchor) return grow(anchor->first, anchor->second);
    for (const Hex& cell : b_.cells) {
      for (const Hex& turned : allTurns(cell)) {
        if (grow(0, turned)) return true;
      }
    }
    return false;
  }

 private:
  using Key = std::array<Index, 4>;
  using Faces = std::map<Key, std::vector<std::size_t>>;
  /// Corners of the six faces, and of each the corner behind it.
  static constexpr std::array<std::array<std::size_t, 8>, 6> kFaces = {{{0, 1, 2, 3, 4, 5, 6, 7},
                                                                        {4, 5, 6, 7, 0, 1, 2, 3},
                                                                        {0, 1, 5, 4, 3, 2, 6, 7},
                                                                        {3, 2, 6, 7, 0, 1, 5, 4},
                                                                        {0, 3, 7, 4, 1, 2, 6, 5},
                                                                        {1, 2, 6, 5, 0, 3, 7, 4}}};

  static Key keyOf(const Hex& cell, std::size_t face) {
    Key key{};
    for (std::size_t i = 0; i < 4; ++i) key[i] = cell[kFaces[face][i]];
    std::sort(key.begin(), key.end());
    return key;
  }

  static Faces collectFaces(const HexMesh& mesh) {
    Faces faces;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      for (std::size_t f = 0; f < 6; ++f) faces[keyOf(mesh.cells[c], f)].push_back(c);
    }
    return faces;
  }

  static std::vector<Hex> allTurns(const Hex& cell) {
    std::vector<Hex> seen = {cell};
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Hex c = seen[i];
      for (const Hex& next : {Hex{c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4]},
                              Hex{c[3], c[2], c[6], c[7], c[0], c[1], c[5], c[4]}}) {
        if (std::find(seen.begin(), seen.end(), next) == seen.end()) seen.push_back(next);
      }
    }
    return seen;
  }

  /// A cell of `a` whose corners lie where those of a cell of `b` do.
  std::optional<std::pair<std::size_t, Hex>> findAnchor() const {
    std::map<Vec3, Index> at;
    for (Index i = 0; i < b_.points.size(); ++i) at[b_.points[i]] = i;
    std::map<Hex, bool> cells;
    for (Hex cell : b_.cells) {
      std::sort(cell.begin(), cell.end());
      cells[cell] = true;
    }
    for (std::size_t c = 0; c < a_.cells.size(); ++c) {
      Hex image{};
      bool known = true;
      for (std::size_t i = 0; i < 8 && known; ++i) {
        const auto found = at.find(a_.points[a_.cells[c][i]]);
        known = found != at.end();
        if (known) image[i] = found->second;
      }
      if (!known) continue;
      Hex sorted = image;
      std::sort(sorted.begin(), sorted.end());
      if (cells.contains(sorted)) return std::pair(c, image);
    }
    return {};
  }

  /// Cells and their images spread across faces until all are reached or something does not fit.
  bool grow(std::size_t first, const Hex& image) {
    imageOf_.assign(a_.points.size(), kNone);
    taken_.assign(b_.points.size(), false);
    std::vector<bool> done(a_.cells.size(), false);
    std::vector<std::pair<std::size_t, Hex>> queue = {{first, image}};
    done[first] = true;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const auto [c, corners] = queue[head];
      if (!assign(a_.cells[c], corners)) return false;
      for (std::size_t f = 0; f < 6; ++f) {
        const std::vector<std::size_t>& here = facesA_.at(keyOf(a_.cells[c], f));
        const auto there = facesB_.find(keyOf(corners, f));
        if (there == facesB_.end() || there->second.size() != here.size()) return false;
        for (const std::size_t next : here) {
          if (next == c || done[next]) continue;
          const std::optional<Hex> nextImage = across(next, c, f, corners, there->second);
          if (!nextImage) return false;
          done[next] = true;
          queue.emplace_back(next, *nextImage);
        }
      }
    }
    return queue.size() == a_.cells.size();
  }

  bool assign(const Hex& cell, const Hex& image) {
    for (std::size_t i = 0; i < 8; ++i) {
      Index& known = imageOf_[cell[i]];
      if (known == image[i]) continue;
      if (known != kNone || taken_[image[i]]) return false;
      known = image[i];
      taken_[image[i]] = true;
    }
    return true;
  }

  /// The image of cell `next`, which shares face f of cell c.
  std::optional<Hex> across(std::size_t next, std::size_t c, std::size_t f, const Hex& corners,
                            const std::vector<std::size_t>& candidates) const {
    for (const std::size_t candidate : candidates) {
      if (sameVertices(b_.cells[candidate], corners)) continue;
      Hex image{};
      for (std::size_t i = 0; i < 4; ++i) {
        const Index v = a_.cells[c][kFaces[f][i]];
        const Index w = corners[kFaces[f][i]];
        const auto [placeA, behindA] = placeAndBehind(a_.cells[next], keyOf(a_.cells[c], f), v);
        const auto [placeB, behindB] = placeAndBehind(b_.cells[candidate], keyOf(corners, f), w);
        image[placeA] = b_.cells[candidate][placeB];
        image[behindA] = b_.cells[candidate][behindB];
      }
      return image;
    }
    return {};
  }

  static bool sameVertices(Hex a, Hex b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
  }

  /// Where a vertex of a face is in a cell, and which corner is behind it.
  static std::pair<std::size_t, std::size_t> placeAndBehind(const Hex& cell, const Key& face,
                                                            Index vertex) {
    for (std::size_t f = 0; f < 6; ++f) {
      if (keyOf(cell, f) != face) continue;
      for (std::size_t i = 0; i < 4; ++i) {
        if (cell[kFaces[f][i]] == vertex) return {kFaces[f][i], kFaces[f][i + 4]};
      }
    }
    return {0, 0};
  }

  const HexMesh& a_;
  const HexMesh& b_;
  Faces facesA_;
  Faces facesB_;
  std::vector<Index> imageOf_;
  std::vector<bool> taken_;
};

[[nodiscard]] inline bool sameConnectivity(const HexMesh& a, const HexMesh& b) {
  return Isomorphism(a, b).exists();
}

}  // namespace hexhex::test
