#include <algorithm>
#include <numeric>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <io/core/cell_counts.hpp>

namespace hexhex::io {
namespace {

/// Whether a VTK type is empty, a point, a line or a polygon, straight or curved.
bool isFlat(std::int64_t type) {
  constexpr std::array<std::int64_t, 31> kFlat = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21,
                                                  22, 23, 28, 30, 34, 35, 36, 51, 52, 53, 54,
                                                  60, 61, 62, 63, 68, 69, 70, 75, 76};
  constexpr std::int64_t kBezierQuad = 77;
  return type == kBezierQuad || std::find(kFlat.begin(), kFlat.end(), type) != kFlat.end();
}

}  // namespace

std::string singular(std::string_view plural) {
  const std::size_t end = std::min(plural.find(" with "), plural.find(" of "));
  std::string noun(plural.substr(0, end));
  const bool greek = noun.ends_with("hedra");
  noun.pop_back();
  if (greek) noun += "on";
  return concat(noun, plural.substr(std::min(end, plural.size())));
}

const VolumeCells* volumeCells(std::int64_t VolumeCells::*number, std::int64_t value) {
  const auto* const found =
      std::find_if(kVolumeCells.begin(), kVolumeCells.end(),
                   [&](const VolumeCells& type) { return value > 0 && type.*number == value; });
  return found == kVolumeCells.end() ? nullptr : found;
}

std::span<const Index> AllCells::operator[](std::size_t i) const {
  if (i < mesh_.cells.size()) return mesh_.cells[i];
  i -= mesh_.cells.size();
  const OtherCellList* kind = others_.kinds.data();
  for (; i >= kind->count(); ++kind) i -= kind->count();
  return {kind->vertices.data() + i * kind->corners, kind->corners};
}

Array<std::int32_t> AllCells::regions() const {
  Array<std::int32_t> regions = mesh_.regions;
  regions.resize(mesh_.cells.size(), 0);
  for (const OtherCellList& kind : others_.kinds) {
    const std::size_t begin = regions.size();
    regions.insert(regions.end(), kind.regions.begin(), kind.regions.end());
    regions.resize(begin + kind.count(), 0);
  }
  const auto isZero = [](std::int32_t region) { return region == 0; };
  if (std::all_of(regions.begin(), regions.end(), isZero)) regions.clear();
  return regions;
}

const OtherCells& noOthers() {
  static const OtherCells none;
  return none;
}

void CellCounts::addVtk(std::int64_t type, std::uint64_t count) {
  if (count == 0 || isFlat(type)) return;
  if (const VolumeCells* const found = volumeCells(&VolumeCells::vtkType, type))
    return add(*found, count);
  unknown_[type] += count;
}

std::uint64_t CellCounts::of(const CellKind& kind) const {
  const auto found = counts_.find(kind.plural);
  return found == counts_.end() ? 0 : found->second;
}

std::vector<CellCount> CellCounts::list() const {
  std::vector<CellCount> list;
  for (const auto& [plural, count] : counts_) {
    if (count > 0) list.push_back({std::string(plural), count});
  }
  for (const auto& [type, count] : unknown_) {
    list.push_back({concat("cells of VTK's type ", type), count});
  }
  return list;
}

std::string CellCounts::text() const {
  const std::vector<CellCount> all = list();
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) text += i + 1 == all.size() ? " and " : ", ";
    const auto& [name, count] = all[i];
    text += concat(count, ' ', (count == 1 ? singular(name) : name));
  }
  return text;
}

std::string CellCounts::instead() const {
  const std::vector<CellCount> all = list();
  if (all.empty()) return {};
  const bool onlyTets = all.size() == 1 && all.front().name == "tetrahedra";
  return "; it holds " + text() +
         (onlyTets ? ", of which `hexhex mesh` makes hexahedra (docs/user/making-maps.md)" : "");
}

std::string CellCounts::adviceOnCurved() const {
  bool hasCurved = false;
  bool hasOthers = !unknown_.empty();
  for (const auto& [plural, count] : counts_) {
    const bool curved = plural == "Lagrange hexahedra" || (plural.starts_with("hexahedra with ") &&
                                                           plural != "hexahedra with 24 nodes");
    if (count > 0) (curved ? hasCurved : hasOthers) = true;
  }
  if (!hasCurved) return {};
  if (hasOthers) {
    return " Hexahedra of order 2 and more are curved, and read where there are no other cells. "
           "Give the others a file of their own.";
  }
  return " Cells of order 2 and more are curved: `hexhex view` and `hexhex improve` read them, and "
         "`hexhex convert` writes them as .vtu, .msh or MFEM .mesh, those of order 2 also as "
         ".meshb, .inp, .exo or .cgns.";
}

void CellCounts::requireOnly(const CellKind& kind, const std::string& fileName,
                             std::string_view advice, const OtherCells& read) const {
  const std::vector<CellCount> all = list();
  const std::uint64_t others =
      std::accumulate(all.begin(), all.end(), std::uint64_t{0},
                      [](std::uint64_t sum, const CellCount& each) { return sum + each.count; }) -
      of(kind);
  if (others == read.count()) return;
  throw Error(ErrorCode::FileUnsupported,
              concat(fileName, ": the file holds ", text(), ", but all cells must be ", kind.plural,
                     ". ", advice));
}

}  // namespace hexhex::io
