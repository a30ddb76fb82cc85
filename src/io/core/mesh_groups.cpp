#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <optional>
#include <span>

#include <adjacency/hex_faces.hpp>
#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/mesh_groups.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 12;

using Tag = std::int32_t;

/// Tags of elements, and the order that sorts elements by tag without mixing equal ones. Elements
/// with tag 0 come last.
class TagOrder {
 public:
  explicit TagOrder(std::span<const Tag> tags) : tags_(tags), order_(tags.size()) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (tags[i] != 0) order_[next++] = i;
    }
    const auto untagged = order_.begin() + static_cast<std::ptrdiff_t>(next);
    std::stable_sort(order_.begin(), untagged,
                     [tags](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (tags[i] == 0) order_[next++] = i;
    }
  }

  /// Which element stands at a place of the sorted list.
  [[nodiscard]] std::size_t operator[](std::size_t i) const { return order_[i]; }
  [[nodiscard]] std::size_t size() const { return order_.size(); }

  /// @param kind, untagged  what names are made of, for elements with a tag and without
  [[nodiscard]] std::vector<ElementGroup> groups(const std::string& kind,
                                                 const char* untagged = "boundary") const {
    std::vector<ElementGroup> groups;
    const bool numbersAreTags = canNumberByTags();
    std::uint32_t last = 0;
    for (std::size_t begin = 0; begin < size();) {
      std::size_t end = begin + 1;
      while (end < size() && tags_[order_[end]] == tags_[order_[begin]]) ++end;
      const Tag tag = tags_[order_[begin]];
      last = numbersAreTags && tag != 0 ? static_cast<std::uint32_t>(tag) : last + 1;
      groups.push_back({last, nameOf(kind, untagged, tag), begin, end, tag});
      begin = end;
    }
    return groups;
  }

 private:
  /// The largest tag needs a successor for the untagged elements.
  [[nodiscard]] bool canNumberByTags() const {
    return std::all_of(tags_.begin(), tags_.end(),
                       [](Tag tag) { return tag >= 0 && tag < std::numeric_limits<Tag>::max(); });
  }
  static std::string nameOf(const std::string& kind, const char* untagged, Tag tag) {
    if (tag == 0) return untagged;
    const std::int64_t wide = tag;
    std::string name = kind;
    name += wide < 0 ? "_m" : "_";
    name += std::to_string(wide < 0 ? -wide : wide);
    return name;
  }

  std::span<const Tag> tags_;
  Array<std::size_t> order_;
};

template <class Vertices>
void requireVertices(const HexMesh& mesh, const Vertices& vertices, const char* what,
                     std::size_t i) {
  for (const std::uint32_t vertex : vertices) {
    if (vertex < mesh.points.size()) continue;
    throw Error(ErrorCode::InvalidArgument, std::string("Feature ") + what + " " +
                                                std::to_string(i) + " names vertex " +
                                                std::to_string(vertex) + ", but the mesh has " +
                                                std::to_string(mesh.points.size()) + " vertices.");
  }
}

/// Without those of tag 0, which means "no feature".
template <class Feature>
std::vector<Feature> withTags(const std::vector<Feature>& features) {
  std::vector<Feature> tagged;
  std::copy_if(features.begin(), features.end(), std::back_inserter(tagged),
               [](const Feature& feature) { return feature.tag != 0; });
  return tagged;
}

template <class Feature>
Array<Tag> tagsOf(const std::vector<Feature>& features) {
  Array<Tag> tags(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) tags[i] = features[i].tag;
  return tags;
}

/// Finds tagged quads by their vertices, in whatever order.
class FeatureQuadTable {
 public:
  explicit FeatureQuadTable(std::span<const FeatureQuad> quads) {
    entries_.reserve(quads.size());
    for (std::size_t i = 0; i < quads.size(); ++i) {
      if (quads[i].tag != 0) entries_.emplace_back(sorted(quads[i].vertices), i);
    }
    std::sort(entries_.begin(), entries_.end());
  }

  [[nodiscard]] std::optional<std::size_t> find(const Quad& quad) const {
    const Entry wanted{sorted(quad), 0};
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), wanted);
    if (found == entries_.end() || found->first != wanted.first) return std::nullopt;
    return found->second;
  }

 private:
  using Entry = std::pair<Quad, std::size_t>;
  static Quad sorted(Quad quad) {
    std::sort(quad.begin(), quad.end());
    return quad;
  }
  std::vector<Entry> entries_;
};

/// Quads before they are sorted into groups.
struct TaggedQuads {
  Array<Quad> quads;
  Array<std::uint64_t> places;
  Array<Tag> tags;
  const char* kind = "surface";
};

/// Tags boundary quads by smooth patch.
void tagPatches(const HexMesh& mesh, double angle, TaggedQuads& found, Stage& stage) {
  const SmoothPatches patches =
      findSmoothPatches(mesh.points, found.quads, angle, mesh.features.edges, stage);
  if (patches.count <= 1) return;
  found.kind = "patch";
  for (std::size_t i = 0; i < found.quads.size(); ++i) {
    found.tags[i] = static_cast<Tag>(patches.patchOf[i] + 1);
  }
}

TaggedQuads findQuads(const HexMesh& mesh, double patchAngle, Stage& stage) {
  const std::vector<FeatureQuad>& features = mesh.features.quads;
  TaggedQuads found;
  found.places = boundaryPlaces(mesh, stage);
  found.quads = quadsAt(mesh, found.places);
  found.tags.resize(found.quads.size());
  std::fill(found.tags.begin(), found.tags.end(), Tag{0});
  const auto isTagged = [](const FeatureQuad& quad) { return quad.tag != 0; };
  if (std::none_of(features.begin(), features.end(), isTagged)) {
    if (patchAngle > 0) tagPatches(mesh, patchAngle, found, stage);
    return found;
  }
  const FeatureQuadTable table(features);
  std::vector<std::uint8_t> onBoundary(features.size(), 0);
  parallelFor(stage, found.quads.size(), kGrain, [&](std::size_t i) {
    const std::optional<std::size_t> feature = table.find(found.quads[i]);
    found.tags[i] = feature ? features[*feature].tag : 0;
    if (feature) onBoundary[*feature] = 1;  // no other boundary quad has these vertices
  });
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
  const std::vector<FeatureVertex> features = withTags(mesh.features.vertices);
  const Array<Tag> tags = tagsOf(features);
  const TagOrder order(tags);
  VertexGroups result{order.groups("point"), Array<std::array<Index, 1>>(features.size())};
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Index vertex = features[order[i]].vertex;
    requireVertices(mesh, std::array{vertex}, "vertex", order[i]);
    result.elements[i] = {vertex};
  }
  return result;
}

EdgeGroups groupEdges(const HexMesh& mesh) {
  const std::vector<FeatureEdge> features = withTags(mesh.features.edges);
  const Array<Tag> tags = tagsOf(features);
  const TagOrder order(tags);
  EdgeGroups result{order.groups("curve"), Array<std::array<Index, 2>>(features.size())};
  for (std::size_t i = 0; i < features.size(); ++i) {
    requireVertices(mesh, features[order[i]].vertices, "edge", order[i]);
    result.elements[i] = features[order[i]].vertices;
  }
  return result;
}

QuadGroups groupQuads(const HexMesh& mesh, double patchAngle, Stage& stage) {
  for (std::size_t i = 0; i < mesh.features.quads.size(); ++i) {
    requireVertices(mesh, mesh.features.quads[i].vertices, "quad", i);
  }
  for (std::size_t i = 0; i < mesh.features.edges.size(); ++i) {
    requireVertices(mesh, mesh.features.edges[i].vertices, "edge", i);
  }
  TaggedQuads found = findQuads(mesh, patchAngle, stage);
  const TagOrder order(found.tags);
  QuadGroups result{order.groups(found.kind), {}, {}};
  // The usual case: one group, in order.
  if (result.groups.size() <= 1) {
    result.elements = std::move(found.quads);
    result.places = std::move(found.places);
    return result;
  }
  result.elements.resize(order.size());
  result.places.resize(order.size());
  parallelFor(stage, order.size(), kGrain, [&](std::size_t i) {
    result.elements[i] = found.quads[order[i]];
    result.places[i] = found.places[order[i]];
  });
  return result;
}

CellGroups groupCells(const HexMesh& mesh) {
  if (mesh.regions.empty()) return {{{1, "hexahedra", 0, mesh.cells.size()}}, {}};
  const TagOrder order(mesh.regions);
  CellGroups result{order.groups("region", "hexahedra"), {}};
  if (result.groups.empty()) result.groups.push_back({1, "hexahedra", 0, 0});
  if (result.groups.size() == 1) return result;
  result.order.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) result.order[i] = static_cast<Index>(order[i]);
  return result;
}

namespace {

/// @param groups  all of the same kind of elements
std::uint32_t referenceOf(const ElementGroup& group, std::size_t groups, Untagged untagged) {
  return untagged == Untagged::Zero && group.tag == 0 && groups > 1 ? 0 : group.number;
}

}  // namespace

Array<std::uint32_t> cellReferences(const HexMesh& mesh, Untagged untagged) {
  if (mesh.regions.empty()) return {};
  const CellGroups groups = groupCells(mesh);
  Array<std::uint32_t> references(mesh.cells.size());
  for (const ElementGroup& group : groups.groups) {
    const std::uint32_t reference = referenceOf(group, groups.groups.size(), untagged);
    for (std::size_t i = group.begin; i < group.end; ++i) references[groups.at(i)] = reference;
  }
  return references;
}

Array<std::uint32_t> vertexReferences(const HexMesh& mesh, const VertexGroups& groups) {
  if (groups.elements.empty()) return {};
  Array<std::uint32_t> references(mesh.points.size());
  std::fill(references.begin(), references.end(), 0U);
  for (const ElementGroup& group : groups.groups) {
    for (std::size_t i = group.begin; i < group.end; ++i) {
      references[groups.elements[i][0]] = group.number;
    }
  }
  return references;
}

Array<std::uint32_t> groupNumbers(const std::vector<ElementGroup>& groups, Untagged untagged) {
  Array<std::uint32_t> numbers(groups.empty() ? 0 : groups.back().end);
  for (const ElementGroup& group : groups) {
    std::fill(numbers.begin() + static_cast<std::ptrdiff_t>(group.begin),
              numbers.begin() + static_cast<std::ptrdiff_t>(group.end),
              referenceOf(group, groups.size(), untagged));
  }
  return numbers;
}

}  // namespace hexhex
