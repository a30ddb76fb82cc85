// Groups of elements; and named boundary patches: the groups that files get, with area, centre and
// normal.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <adjacency/corner_range.hpp>
#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/patches.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/text_scanner.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex::io {

namespace {

constexpr std::size_t kMeshGroupsGrain = std::size_t{1} << 12;

using Tag = std::int32_t;

/// The order that sorts elements by tag without mixing equal ones. Elements with tag 0 come last.
Array<std::size_t> orderByTag(std::span<const Tag> tags) {
  Array<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto untagged = std::stable_partition(order.begin(), order.end(),
                                              [tags](std::size_t i) { return tags[i] != 0; });
  std::stable_sort(order.begin(), untagged,
                   [tags](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
  return order;
}

/// Words that names of groups are built from, for elements with and without a tag.
struct GroupWords {
  std::string tagged;
  const char* untagged = "boundary";
  std::map<Tag, std::string> names = {};  ///< names given by the features
};

/// A name valid in every format: letters, digits and '_', at most 32, not starting with a digit.
std::string wordOf(std::string_view name) {
  constexpr std::size_t kLongest = 32;
  std::string word;
  for (const char c : name.substr(0, kLongest - 1)) {
    const bool isDigit = c >= '0' && c <= '9';
    const bool isLetter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (word.empty() && isDigit) word += '_';
    word += isDigit || isLetter ? c : '_';
  }
  return word;
}

/// Names of groups given by the file that the mesh came from. Some formats ignore case, so a name
/// that equals an earlier one up to case is dropped.
/// @param dimension  of the elements
std::map<Tag, std::string> givenNames(std::span<const TagName> names, int dimension) {
  std::map<Tag, std::string> given;
  std::set<std::string> earlier;
  for (const TagName& known : names) {
    std::string word = wordOf(known.name);
    std::string small = word;
    for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    const bool isNew = earlier.insert(std::move(small)).second;
    if (known.dimension != dimension) continue;
    given.emplace(known.tag, isNew ? std::move(word) : std::string());
  }
  return given;
}

std::string groupName(const GroupWords& words, Tag tag) {
  if (tag == 0) return words.untagged;
  const auto given = words.names.find(tag);
  if (given != words.names.end() && !given->second.empty()) return given->second;
  const std::int64_t wide = tag;
  return concat(words.tagged, (wide < 0 ? "_m" : "_"), wide < 0 ? -wide : wide);
}

/// Whether tags serve as group numbers: all nonnegative, with a successor for untagged elements.
bool numbersAreTags(std::span<const Tag> tags) {
  return std::all_of(tags.begin(), tags.end(),
                     [](Tag tag) { return tag >= 0 && tag < std::numeric_limits<Tag>::max(); });
}

/// @param order  indices of all elements, sorted by tag
std::vector<ElementGroup> groupsOf(std::span<const Tag> tags, std::span<const std::size_t> order,
                                   const GroupWords& words) {
  const bool byTag = numbersAreTags(tags);
  std::vector<ElementGroup> groups;
  std::uint32_t last = 0;
  for (std::size_t begin = 0; begin < order.size();) {
    const Tag tag = tags[order[begin]];
    std::size_t end = begin + 1;
    while (end < order.size() && tags[order[end]] == tag) ++end;
    last = byTag && tag != 0 ? static_cast<std::uint32_t>(tag) : last + 1;
    groups.push_back({last, groupName(words, tag), begin, end, tag});
    begin = end;
  }
  return groups;
}

template <class Vertices>
void requireVertices(const HexMesh& mesh, const Vertices& vertices, const char* what,
                     std::size_t i) {
  for (const std::uint32_t vertex : vertices) {
    if (vertex < mesh.points.size()) continue;
    throw Error(ErrorCode::InvalidArgument,
                concat("Feature ", what, " ", i, " names vertex ", vertex, ", but the mesh has ",
                       mesh.points.size(), " vertices."));
  }
}

/// Groups of all features except those with tag 0, which means "no feature".
template <std::size_t n, class Feature>
ElementGroups<n> groupFeatures(const HexMesh& mesh, const std::vector<Feature>& all,
                               const char* what, const GroupWords& words) {
  std::vector<Feature> features;
  Array<Tag> tags;
  for (const Feature& feature : all) {
    if (feature.tag == 0) continue;
    features.push_back(feature);
    tags.push_back(feature.tag);
  }
  const Array<std::size_t> order = orderByTag(tags);
  ElementGroups<n> result{groupsOf(tags, order, words), {}};
  result.elements.reserve(features.size());
  for (const std::size_t i : order) {
    requireVertices(mesh, verticesOf(features[i]), what, i);
    result.elements.push_back(verticesOf(features[i]));
  }
  return result;
}

/// Quads before they are sorted into groups.
struct TaggedQuads {
  Array<Quad> quads;
  std::vector<std::uint64_t> places;
  Array<Tag> tags;
  Tag lastTag = std::numeric_limits<Tag>::max();  ///< larger tags denote smooth patches
};

/// Tags boundary quads by smooth patch, with numbers above all existing tags.
void tagPatches(const HexMesh& mesh, double angle, TaggedQuads& found, Stage& stage) {
  const mesh::SmoothPatches patches =
      mesh::findSmoothPatches(mesh.points, found.quads, angle, mesh.features.edges, stage);
  Tag last = 0;
  for (const FeatureQuad& quad : mesh.features.quads) last = std::max(last, quad.tag);
  const bool haveRoom = patches.count < static_cast<Index>(found.lastTag - last);
  if (patches.count <= 1 || !haveRoom) return;
  found.lastTag = last;
  for (std::size_t i = 0; i < found.quads.size(); ++i) {
    found.tags[i] = last + 1 + static_cast<Tag>(patches.patchOf[i]);
  }
}

/// Faces are the same if these are equal.
Quad faceKey(Quad face) {
  if (cornersOf(face) == 3) face[3] = kNone;
  return sorted(face);
}

/// Makes the boundary of the hexahedra that of all cells. Quads come before triangles.
void joinOthers(const HexMesh& mesh, const OtherCells& others, TaggedQuads& found) {
  const AllCells cells(mesh, others);
  for (const std::size_t corners : {4U, 3U}) {
    for (std::size_t i = mesh.cells.size(); i < cells.size(); ++i) {
      for (std::size_t face = 0; face < kFaceCounts[cells[i].size()]; ++face) {
        const Quad quad = faceAt(cells[i], face);
        if (cornersOf(quad) != corners) continue;
        found.quads.push_back(quad);
        found.places.push_back(8 * std::uint64_t{i} + face);
      }
    }
  }
  std::vector<std::pair<Quad, std::size_t>> table;  // by vertices
  table.reserve(found.quads.size());
  for (const Quad& quad : found.quads) table.emplace_back(faceKey(quad), table.size());
  std::sort(table.begin(), table.end());
  std::vector<std::size_t> kept;  // faces of one cell
  const auto isSame = [](const auto& a, const auto& b) { return a.first == b.first; };
  adjacency::forEachRun(std::span<const std::pair<Quad, std::size_t>>(table), isSame,
                        [&](auto run) {
                          if (run.size() == 1) kept.push_back(run[0].second);
                        });
  std::sort(kept.begin(), kept.end());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    found.quads[i] = found.quads[kept[i]];
    found.places[i] = found.places[kept[i]];
  }
  found.quads.resize(kept.size());
  found.places.resize(kept.size());
}

TaggedQuads findQuads(const HexMesh& mesh, double patchAngle, Stage& stage,
                      const std::function<bool(std::uint64_t)>& isInside,
                      const OtherCells& others) {
  std::vector<FeatureQuad> features = mesh.features.quads;
  for (const auto& [v, tag] : others.triangles) features.push_back({{v[0], v[1], v[2], v[2]}, tag});
  TaggedQuads found;
  found.places = adjacency::boundaryPlaces(mesh, stage);
  if (isInside) std::erase_if(found.places, isInside);
  found.quads = adjacency::quadsAt(mesh, found.places);
  if (others.count() > 0) joinOthers(mesh, others, found);
  found.tags.resize(found.quads.size());
  std::fill(found.tags.begin(), found.tags.end(), Tag{0});
  std::vector<std::pair<Quad, std::size_t>> table;  // by sorted vertices
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (features[i].tag != 0) table.emplace_back(faceKey(features[i].vertices), i);
  }
  std::sort(table.begin(), table.end());
  std::vector<std::uint8_t> onBoundary(features.size(), 0);
  parallelFor(stage, found.quads.size(), kMeshGroupsGrain, [&](std::size_t i) {
    const std::pair<Quad, std::size_t> wanted{faceKey(found.quads[i]), 0};
    const auto feature = std::lower_bound(table.begin(), table.end(), wanted);
    if (feature == table.end() || feature->first != wanted.first) return;
    found.tags[i] = features[feature->second].tag;
    onBoundary[feature->second] = 1;  // no other boundary quad has these vertices
  });
  const bool isBoundaryTagged =
      std::find(onBoundary.begin(), onBoundary.end(), 1) != onBoundary.end();
  if (!isBoundaryTagged && patchAngle > 0) tagPatches(mesh, patchAngle, found, stage);
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (onBoundary[i] != 0 || features[i].tag == 0) continue;
    found.quads.push_back(features[i].vertices);
    found.places.push_back(kNoPlace);
    found.tags.push_back(features[i].tag);
  }
  return found;
}

}  // namespace

VertexGroups groupVertices(const HexMesh& mesh) {
  return groupFeatures<1>(mesh, mesh.features.vertices, "vertex",
                          {"point", "", givenNames(mesh.features.names, 0)});
}

EdgeGroups groupEdges(const HexMesh& mesh) {
  return groupFeatures<2>(mesh, mesh.features.edges, "edge",
                          {"curve", "", givenNames(mesh.features.names, 1)});
}

void addMissingGroups(std::vector<ElementGroup>& groups, std::vector<std::int32_t> tags,
                      bool untagged, const std::string& word, const char* nameless) {
  std::vector<ElementGroup> all;
  const bool byTag = numbersAreTags(tags);
  if (untagged) tags.push_back(0);
  auto own = groups.begin();
  std::uint32_t last = 0;
  std::size_t begin = 0;
  for (const std::int32_t tag : tags) {
    last = byTag && tag != 0 ? static_cast<std::uint32_t>(tag) : last + 1;
    const bool has = own != groups.end() && own->tag == tag;
    const std::size_t end = has ? own->end : begin;
    all.push_back({last, groupName({word, nameless}, tag), begin, end, tag});
    begin = end;
    if (has) ++own;
  }
  groups = std::move(all);
}

QuadGroups groupQuads(const HexMesh& mesh, double patchAngle, Stage& stage,
                      const std::function<bool(std::uint64_t)>& isInside,
                      const OtherCells& others) {
  for (std::size_t i = 0; i < mesh.features.quads.size(); ++i) {
    requireVertices(mesh, mesh.features.quads[i].vertices, "quad", i);
  }
  for (std::size_t i = 0; i < others.triangles.size(); ++i) {
    requireVertices(mesh, others.triangles[i].vertices, "triangle", i);
  }
  for (std::size_t i = 0; i < mesh.features.edges.size(); ++i) {
    requireVertices(mesh, mesh.features.edges[i].vertices, "edge", i);
  }
  QuadGroups result;
  withThreads(stage.context().threads(), [&] {
    const TaggedQuads found = findQuads(mesh, patchAngle, stage, isInside, others);
    const Array<std::size_t> order = orderByTag(found.tags);
    result.groups =
        groupsOf(found.tags, order, {"surface", "boundary", givenNames(mesh.features.names, 2)});
    for (ElementGroup& group : result.groups) {
      if (group.tag > found.lastTag) group.name = groupName({"patch"}, group.tag - found.lastTag);
    }
    result.elements.resize(order.size());
    result.places.resize(order.size());
    parallelFor(stage, order.size(), kMeshGroupsGrain, [&](std::size_t i) {
      result.elements[i] = found.quads[order[i]];
      result.places[i] = found.places[order[i]];
    });
  });
  return result;
}

CellGroups groupCells(const HexMesh& mesh, const OtherCells& others) {
  const char* const all = others.count() > 0 ? "all_cells" : "hexahedra";
  const AllCells cells(mesh, others);
  const Array<Tag> ofAll = others.count() > 0 ? cells.regions() : Array<Tag>();
  const std::span<const Tag> regions = others.count() > 0 ? ofAll : mesh.regions;
  if (regions.empty()) return {{{1, all, 0, cells.size()}}, {}};
  const Array<std::size_t> order = orderByTag(regions);
  CellGroups result{groupsOf(regions, order, {"region", all, givenNames(mesh.features.names, 3)}),
                    {}};
  if (result.groups.size() == 1) return result;
  result.order.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) result.order[i] = static_cast<Index>(order[i]);
  return result;
}

std::size_t QuadGroups::boundaryEnd(const ElementGroup& group) const {
  const auto end = std::find(places.begin() + static_cast<std::ptrdiff_t>(group.begin),
                             places.begin() + static_cast<std::ptrdiff_t>(group.end), kNoPlace);
  return static_cast<std::size_t>(end - places.begin());
}

MeshGroups::MeshGroups(const HexMesh& mesh, const WriteOptions& options, Stage& stage)
    : vertices(groupVertices(mesh)),
      edges(groupEdges(mesh)),
      quads(groupQuads(mesh, options.patchAngle, stage, nullptr, othersOf(options))),
      cells(groupCells(mesh, othersOf(options))) {}

void requireInt32(std::size_t count, const std::string& numbers, const std::string& instead) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (count <= kMost) return;
  throw Error(ErrorCode::TooLarge, concat(numbers, " with 31 bits, which do not suffice for ",
                                          count, "; ", instead, "."));
}

Array<std::uint32_t> cellReferences(const HexMesh& mesh, Untagged untagged,
                                    const OtherCells& others) {
  const CellGroups groups = groupCells(mesh, others);
  if (mesh.regions.empty() && groups.groups.size() == 1 && groups.groups[0].tag == 0) return {};
  const Array<std::uint32_t> numbers = groupNumbers(groups.groups, untagged);
  Array<std::uint32_t> references(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) references[groups.at(i)] = numbers[i];
  return references;
}

Array<std::uint32_t> vertexReferences(const HexMesh& mesh, const VertexGroups& groups) {
  if (groups.elements.empty()) return {};
  const Array<std::uint32_t> numbers = groupNumbers(groups.groups);
  Array<std::uint32_t> references(mesh.points.size());
  std::fill(references.begin(), references.end(), 0U);
  for (std::size_t i = 0; i < numbers.size(); ++i) references[groups.elements[i][0]] = numbers[i];
  return references;
}

Array<std::uint32_t> groupNumbers(const std::vector<ElementGroup>& groups, Untagged untagged) {
  Array<std::uint32_t> numbers(groups.empty() ? 0 : groups.back().end);
  for (const ElementGroup& group : groups) {
    const bool zero = untagged == Untagged::Zero && group.tag == 0 && groups.size() > 1;
    std::fill(numbers.begin() + static_cast<std::ptrdiff_t>(group.begin),
              numbers.begin() + static_cast<std::ptrdiff_t>(group.end), zero ? 0 : group.number);
  }
  return numbers;
}

namespace {

CellGroups groupOwnCells(const MeshPart& part, const PartsInfo& info) {
  if (info.regions.empty())
    return {{{1, "hexahedra", 0, static_cast<std::size_t>(part.ownCells)}}, {}};
  HexMesh own;  // regions alone
  own.cells.resize(part.ownCells);
  own.regions.assign(part.mesh.regions.begin(),
                     part.mesh.regions.begin() + static_cast<std::ptrdiff_t>(part.ownCells));
  CellGroups cells = groupCells(own);
  std::vector<std::int32_t> tags = info.regions;
  const bool hasZero = std::erase(tags, 0) > 0;
  if (part.ownCells == 0) cells.groups.clear();
  addMissingGroups(cells.groups, tags, hasZero, "region", "hexahedra");
  return cells;
}

}  // namespace

MeshGroups groupPart(const MeshPart& part, const PartsInfo& info, Stage& stage) {
  std::vector<std::uint64_t> between;
  for (const PartNeighbour& neighbour : part.neighbours) {
    for (const PartFace& face : neighbour.faces) {
      between.push_back(8 * std::uint64_t{face.cell} + face.side);
    }
  }
  std::sort(between.begin(), between.end());
  const auto isInside = [&](std::uint64_t place) {
    return place / 8 >= part.ownCells || std::binary_search(between.begin(), between.end(), place);
  };
  VertexGroups vertices = groupVertices(part.mesh);
  EdgeGroups edges = groupEdges(part.mesh);
  QuadGroups quads = groupQuads(part.mesh, 0, stage, isInside);
  addMissingGroups(vertices.groups, info.vertexTags, false, "point", "");
  addMissingGroups(edges.groups, info.edgeTags, false, "curve", "");
  addMissingGroups(quads.groups, info.quadTags, true, "surface", "boundary");
  return {std::move(vertices), std::move(edges), std::move(quads), groupOwnCells(part, info)};
}

std::optional<std::int32_t> tagInGroupName(std::string_view name, int dimension) {
  constexpr std::array<std::pair<std::string_view, int>, 5> kTagged = {
      {{"point_", 0}, {"curve_", 1}, {"surface_", 2}, {"patch_", 2}, {"region_", 3}}};
  const auto fits = [dimension](int own) { return dimension == -1 || dimension == own; };
  const bool isAllCells = name == "hexahedra" || name == "all_cells";
  if ((name == "boundary" && fits(2)) || (isAllCells && fits(3))) return 0;
  for (const auto& [prefix, own] : kTagged) {
    if (!name.starts_with(prefix) || !fits(own)) continue;
    std::string_view digits = name.substr(prefix.size());
    const bool negative = digits.starts_with('m');
    if (negative) digits.remove_prefix(1);
    if (negative && digits.starts_with('-')) return {};  // only one sign is allowed
    std::int64_t tag = 0;
    if (!parseInteger(digits, tag)) return {};
    tag = negative ? -tag : tag;
    if (tag == 0 || !std::in_range<std::int32_t>(tag)) return {};
    return prefix == "patch_" ? 0 : static_cast<std::int32_t>(tag);
  }
  return {};
}

void numberApart(std::initializer_list<std::vector<ElementGroup>*> kinds) {
  std::set<std::uint32_t> taken;
  std::vector<ElementGroup*> others;
  for (std::vector<ElementGroup>* const groups : kinds) {
    for (ElementGroup& group : *groups) {
      // Given names do not encode the tag.
      const auto tag = tagInGroupName(group.name).value_or(group.tag);
      const bool isTag = tag == static_cast<std::int64_t>(group.number);
      if (!isTag || !taken.insert(group.number).second) others.push_back(&group);
    }
  }
  std::uint32_t next = 1;
  for (ElementGroup* const group : others) {
    if (taken.insert(group->number).second) continue;
    while (!taken.insert(next).second) ++next;
    group->number = next;
  }
}

namespace {

/// Sums area, centre and normal over the corner triangles of quads. These cover each quad twice,
/// once per diagonal, so each counts half.
void measurePatch(std::span<const Vec3> points, NamedPatch& patch) {
  Vec3 moment{};
  for (const Quad& quad : patch.quads) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::array corners = {points[quad[(i + 3) % 4]], points[quad[i]],
                                  points[quad[(i + 1) % 4]]};
      const Vec3 twice = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
      const double area = length(twice) / 4;
      patch.area += area;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        patch.normal[axis] += twice[axis] / 4;
        moment[axis] += area * (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3;
      }
    }
  }
  if (!(patch.area > 0)) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    patch.centre[axis] = moment[axis] / patch.area;
    patch.normal[axis] /= patch.area;
  }
}

}  // namespace

}  // namespace hexhex::io

namespace hexhex {

std::vector<NamedPatch> namedPatches(const HexMesh& mesh, double angle, Context& context) {
  mesh::requirePatchAngle(angle);
  return inStage(context, "namedPatches", "patches", [&](Stage& stage) {
    withThreads(context.threads(), [&] { adjacency::requireCornersInRange(mesh, stage); });
    const io::QuadGroups groups = io::groupQuads(mesh, angle, stage);
    std::int32_t lastTag = 0;  // larger tags denote smooth patches
    for (const FeatureQuad& quad : mesh.features.quads) lastTag = std::max(lastTag, quad.tag);
    std::vector<NamedPatch> patches;
    for (const io::ElementGroup& group : groups.groups) {
      const auto quadAt = [&](std::size_t i) {
        return groups.elements.begin() + static_cast<std::ptrdiff_t>(i);
      };
      const std::size_t end = groups.boundaryEnd(group);
      if (end == group.begin) continue;  // all interior
      NamedPatch& patch = patches.emplace_back();
      patch.name = group.name;
      patch.tag = group.tag > lastTag ? 0 : group.tag;
      patch.quads.assign(quadAt(group.begin), quadAt(end));
      io::measurePatch(mesh.points, patch);
    }
    return patches;
  });
}

}  // namespace hexhex
