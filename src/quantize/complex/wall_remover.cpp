#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <quantize/complex/wall_remover.hpp>

namespace hexhex::quantization {

namespace {

/// Thicknesses count as equal below this power of two, in lattice units (2^52 per map).
constexpr int kThicknessBits = 28;

class WallRemover {
 public:
  explicit WallRemover(MotorcycleComplex& complex)
      : complex_(complex),
        blocks_(complex.blockCount),
        extents_(complex.patches.size()),
        isFeature_(complex.patches.size()),
        isJoined_(complex.patches.size()),
        sidesAt_(complex.arcs.size()) {
    for (Index p = 0; p < complex.patches.size(); ++p) {
      const PatchSide& patch = complex.patches[p];
      blocks_[patch.block].add(patch);
      extents_[p].add(patch);
      for (const ArcSide& side : patch.border) {
        sidesAt_[side.arc].push_back({p, side.arc, side.axis});
      }
    }
    for (adjacency::HalfFace h = 0; h < complex.patchOf.size(); ++h) {
      if (complex.mesh.isFeature[h]) isFeature_[complex.patchOf[h]] = true;
    }
    for (Index p = 0; p < complex.patches.size(); ++p) {
      for (const ArcSide& side : complex.patches[p].border) {
        if (complex.arcs[side.arc].isFeature) isFeature_[p] = true;
      }
    }
  }

  /// @return whether any wall was removed
  bool run() {
    std::vector<std::pair<std::int64_t, Index>> removable;
    for (Index p = 0; p < complex_.patches.size(); ++p) {
      const std::int64_t thick = thicknessBeside(p);
      // Drops noise, which would decide in symmetric maps.
      if (thick > 0) removable.emplace_back(thick >> kThicknessBits, p);
    }
    std::sort(removable.begin(), removable.end());
    std::vector<bool> isChanged(complex_.blockCount);
    std::vector<bool> isRemoved(complex_.patches.size());
    bool isAny = false;
    for (const auto& [thick, p] : removable) {
      const Index other = complex_.acrossPatch(p);
      const Index a = complex_.patches[p].block;
      const Index b = complex_.patches[other].block;
      if (isChanged[a] || isChanged[b] || !joinPatchesAround(p)) continue;
      isChanged[a] = isChanged[b] = true;
      isRemoved[p] = isRemoved[other] = isAny = true;
    }
    for (adjacency::HalfFace h = 0; h < complex_.patchOf.size(); ++h) {
      const Index p = complex_.patchOf[h];
      if (p != kNone && isRemoved[p]) complex_.mesh.isWall[h] = false;
    }
    return isAny;
  }

 private:
  /// Thickness of the thinner of the two blocks beside a removable wall, otherwise 0.
  [[nodiscard]] std::int64_t thicknessBeside(Index p) const {
    const Index other = complex_.acrossPatch(p);
    if (other == kNone || other < p || isFeature_[p]) return 0;
    const PatchSide& here = complex_.patches[p];
    const PatchSide& there = complex_.patches[other];
    if (here.block == there.block) return 0;
    return std::min(thickness(here), thickness(there));
  }
  /// A patch at an arc that runs along an axis of the patch's block.
  struct SideAtArc {
    Index patch;
    Index arc;
    std::size_t axis;
  };

  /// Where no other wall ends at an arc of the removed one, the patches beyond it on both sides
  /// merge. Marks them as joined.
  /// @return false, without a change, if the result might not be a rectangle
  bool joinPatchesAround(Index wall) {
    std::vector<Index> joined;
    for (const ArcSide& at : complex_.patches[wall].border) {
      std::set<Index> sheets;
      for (const SideAtArc& side : sidesAt_[at.arc]) sheets.insert(sheetOf(side.patch));
      if (sheets.size() == 2) return false;  // at a curve with two cells around it
      if (sheets.size() > 3) continue;       // separated by other walls
      for (const SideAtArc& side : sidesAt_[at.arc]) {
        const Index sheet = sheetOf(side.patch);
        if (sheet == sheetOf(wall)) continue;
        if (isJoined_[sheet] || !isWholeSide(side)) return false;
        joined.push_back(sheet);
      }
    }
    for (const Index sheet : joined) isJoined_[sheet] = true;
    return true;
  }

  /// One number for both sides of a patch.
  [[nodiscard]] Index sheetOf(Index p) const { return std::min(p, complex_.acrossPatch(p)); }

  [[nodiscard]] bool isWholeSide(const SideAtArc& side) const {
    const Extent& patch = extents_[side.patch];
    return patch.high[side.axis] - patch.low[side.axis] == complex_.arcs[side.arc].length;
  }

  /// Thickness of a block behind a patch that is an entire side of it, otherwise 0.
  [[nodiscard]] std::int64_t thickness(const PatchSide& patch) const {
    Extent own;
    own.add(patch);
    const lattice::LatticePoint size = own.high - own.low;
    const lattice::LatticePoint whole = blocks_[patch.block].high - blocks_[patch.block].low;
    std::int64_t thick = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (size[k] == 0) {
        thick = whole[k];
      } else if (size[k] != whole[k]) {
        return 0;
      }
    }
    return thick;
  }

  MotorcycleComplex& complex_;
  std::vector<Extent> blocks_;
  std::vector<Extent> extents_;                  ///< per side of a patch
  std::vector<bool> isFeature_;                  ///< per side of a patch: must stay
  std::vector<bool> isJoined_;                   ///< per side of a patch: merged with another patch
  std::vector<std::vector<SideAtArc>> sidesAt_;  ///< per arc
};

}  // namespace

bool removeNeedlessWalls(MotorcycleComplex& complex) { return WallRemover(complex).run(); }

}  // namespace hexhex::quantization
