// What a repair changed of a map, as it was before: memory grows with the patches, not with the
// map.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include <hexhex/types.hpp>

namespace hexhex {

class MapBackup {
 public:
  MapBackup() = default;
  /// Of a map that nothing has been changed of.
  explicit MapBackup(const TetMap& map)
      : pointCount_(map.points.size()), tetCount_(map.tets.size()) {}

  [[nodiscard]] std::size_t pointCount() const noexcept { return pointCount_; }
  [[nodiscard]] std::size_t tetCount() const noexcept { return tetCount_; }

  /// To be called before the corners or parameters of a tet change.
  void keep(const TetMap& map, Index tet);

  /// To be called before tagged edges and faces, or known valences, change.
  void keepLists(const TetMap& map);

  /// The parameters that a tet had; nothing if they never changed.
  [[nodiscard]] const TetParameters* parametersOf(Index tet) const;

  /// Makes the map what it was.
  void restore(TetMap& map) const;

 private:
  struct KeptTet {
    Tet tet;
    TetParameters parameters;
    std::array<std::int8_t, 4> rotations;
  };
  struct KeptLists {
    Features features;
    std::vector<EdgeValence> edgeValences;
  };

  std::size_t pointCount_ = 0;
  std::size_t tetCount_ = 0;
  std::map<Index, KeptTet> tets_;
  std::optional<KeptLists> lists_;  ///< once edges are split
};

}  // namespace hexhex
