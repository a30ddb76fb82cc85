// Where the picture of a chart overlaps itself: finds the points that several vertices claim, and
// gives the tets that claim them charts in which they do not.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

/// Points of a tet in its chart, which it claims for consecutive vertices.
struct Claim {
  ChartRow row;
  std::uint64_t first;
};

/// What became of places that several vertices claimed.
struct OverlapCounts {
  std::uint64_t tets = 0;          ///< with contested points at first
  std::uint64_t charts = 0;        ///< opened for them
  std::uint64_t homelessTets = 0;  ///< that no chart could take
};

template <class Id>
class Overlaps {
 public:
  /// Appends all claims of a tet.
  using ListClaims = std::function<void(Index tet, std::vector<Claim>&)>;

  /// @param charts  receives further charts
  /// @param grid    with the claims of all tets entered, one of each contested point, and all
  /// bricks
  ///                with such points marked
  Overlaps(const PreparedMap& map, ListClaims listClaims, Charts& charts, BrickGrid<Id>& grid)
      : map_(map), listClaims_(std::move(listClaims)), charts_(charts), grid_(grid) {}

  OverlapCounts resolve(Stage& stage);

 private:
  using Bricks = Brick<Id>;

  struct ClaimingTet {
    Index tet;
    std::span<const Claim> claims;
  };
  /// Claims of some tets.
  struct ClaimBlock {
    std::vector<Index> tets;
    std::vector<std::size_t> ends;  ///< per tet: where its claims end
    std::vector<Claim> claims;

    [[nodiscard]] ClaimingTet at(std::size_t i) const {
      const std::size_t begin = i == 0 ? 0 : ends[i - 1];
      return {tets[i], std::span(claims).subspan(begin, ends[i] - begin)};
    }
  };

  [[nodiscard]] std::vector<Index> tetsNearContested(Stage& stage) const;
  [[nodiscard]] std::vector<ClaimBlock> claimsOf(std::span<const Index> tets, Stage& stage) const;
  void mark(const ClaimBlock& block);
  [[nodiscard]] std::vector<ClaimingTet> contestedOf(const ClaimBlock& block) const;
  void clear(const ClaimingTet& tet, BrickCache<Id>& cache);
  [[nodiscard]] bool tryClaim(const ClaimingTet& tet, Index chart);
  void grow(std::size_t seed, Index chart);

  const PreparedMap& map_;
  ListClaims listClaims_;
  Charts& charts_;
  BrickGrid<Id>& grid_;
  std::vector<ClaimingTet> contested_;
  Array<Index> pending_;  ///< per tet: its index in `contested_`, or kNone if it has a chart
};

extern template class Overlaps<std::uint32_t>;
extern template class Overlaps<std::uint64_t>;

}  // namespace hexhex
