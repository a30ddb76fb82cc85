#include <repair/map_backup.hpp>

namespace hexhex {

void MapBackup::keep(const TetMap& map, Index tet) {
  if (tet >= tetCount_ || tets_.contains(tet)) return;
  KeptTet kept{map.tets[tet], map.parameters[tet], {}};
  if (!map.rotations.empty()) kept.rotations = map.rotations[tet];
  tets_.emplace(tet, kept);
}

void MapBackup::keepLists(const TetMap& map) {
  if (!lists_) lists_ = KeptLists{map.features, map.edgeValences};
}

const TetParameters* MapBackup::parametersOf(Index tet) const {
  const auto found = tets_.find(tet);
  return found == tets_.end() ? nullptr : &found->second.parameters;
}

void MapBackup::restore(TetMap& map) const {
  map.points.resize(pointCount_);
  map.tets.resize(tetCount_);
  map.parameters.resize(tetCount_);
  if (!map.rotations.empty()) map.rotations.resize(tetCount_);
  if (!map.regions.empty()) map.regions.resize(tetCount_);
  for (const auto& [tet, kept] : tets_) {
    map.tets[tet] = kept.tet;
    map.parameters[tet] = kept.parameters;
    if (!map.rotations.empty()) map.rotations[tet] = kept.rotations;
  }
  if (!lists_) return;
  map.features = lists_->features;
  map.edgeValences = lists_->edgeValences;
}

}  // namespace hexhex
