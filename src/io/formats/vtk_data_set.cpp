// VTK data sets for writing: of meshes, and of parts.
#include <algorithm>
#include <limits>
#include <string>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <io/formats/vtk_data_set.hpp>

namespace hexhex::io {

namespace {

/// The tag of each vertex, 0 if none.
/// @throws Error InvalidArgument for a vertex index out of range
Array<std::int32_t> vertexTags(const std::vector<FeatureVertex>& features, std::size_t vertices) {
  Array<std::int32_t> tags(vertices);
  std::fill(tags.begin(), tags.end(), 0);
  for (const FeatureVertex& feature : features) {
    if (feature.vertex < tags.size()) {
      tags[feature.vertex] = feature.tag;
      continue;
    }
    throw Error(ErrorCode::InvalidArgument, concat("A feature names vertex ", feature.vertex,
                                                   ", which is not one of the mesh."));
  }
  return tags;
}

/// Elements as rows of integers: vertices and tag.
template <class Feature>
std::vector<std::int64_t> rowsOf(const std::vector<Feature>& features) {
  std::vector<std::int64_t> rows;
  for (const Feature& feature : features) {
    rows.insert(rows.end(), feature.vertices.begin(), feature.vertices.end());
    rows.push_back(feature.tag);
  }
  return rows;
}

/// Whether some list of points lacks these values, as meshes without generators do.
template <class Value>
bool lack(std::span<const PointPiece> lists, std::span<const Value> PointPiece::*values) {
  return std::any_of(lists.begin(), lists.end(), [values](const PointPiece& list) {
    return !list.points.empty() && (list.*values).empty();
  });
}

/// Adds values of lists of points, unless a list lacks them.
/// @tparam T  the number type in the file
template <class T, class Value>
void addLists(VtkDataSet& data, VtkSection section, std::string_view name, std::size_t components,
              std::span<const PointPiece> lists, std::span<const Value> PointPiece::*values) {
  if (lack(lists, values)) return;
  data.add<T>(section, name, components, data.points, [lists, values](const VtkBytes& output) {
    for (const PointPiece& list : lists) output((list.*values).data(), (list.*values).size_bytes());
  });
}

void addCoordinates(VtkDataSet& data, std::span<const PointPiece> lists) {
  addLists<double>(data, VtkSection::Points, "Points", 3, lists, &PointPiece::points);
}

void addGeneratorTets(VtkDataSet& data, std::span<const PointPiece> lists) {
  addLists<Index>(data, VtkSection::PointData, kVtkGeneratorTets, 1, lists,
                  &PointPiece::generatorTet);
}

void addGeneratorCorners(VtkDataSet& data, std::span<const PointPiece> lists) {
  addLists<CornerSet>(data, VtkSection::PointData, kVtkGeneratorCorners, 1, lists,
                      &PointPiece::generatorCorners);
}

void addGeneratorKinds(VtkDataSet& data, std::span<const PointPiece> lists) {
  if (lack(lists, &PointPiece::generatorCorners)) return;
  const auto kinds = [lists](const VtkBytes& output) {
    for (const PointPiece& list : lists) {
      writeValues<std::uint8_t>(output, list.generatorCorners.size(), [&](std::size_t i) {
        return generatorKind(list.generatorCorners[i]);
      });
    }
  };
  data.add<std::uint8_t>(VtkSection::PointData, "generator_kind", 1, data.points, kinds);
}

/// @tparam Corner  the integer type in the file
template <class Corner>
void addCorners(VtkDataSet& data, const VtkPiece& piece, std::size_t each) {
  const std::size_t others = endOf(*piece.others, data.cells);
  const std::uint64_t count = each * (data.cells - piece.others->count()) + others;
  data.add<Corner>(
      VtkSection::Cells, "connectivity", 1, count, [&piece, others](const VtkBytes& output) {
        const auto write = [&output](const auto& corners) {
          // Signed and unsigned integers of equal size have the same bytes here.
          if (sizeof(Corner) == sizeof(corners[0])) {
            output(corners.data(), corners.size_bytes());
          } else {
            writeValues<Corner>(output, corners.size(), [&](std::size_t i) { return corners[i]; });
          }
        };
        std::visit(write, piece.corners);
        writeValues<Corner>(output, others,
                            [&](std::size_t i) { return cornerOf(*piece.others, i); });
      });
}

/// @tparam End  the integer type in the file
template <class End>
void addEnds(VtkDataSet& data, const VtkPiece& piece, std::size_t corners) {
  data.add<End>(
      VtkSection::Cells, "offsets", 1, data.cells, [&piece, corners](const VtkBytes& output) {
        writeValues<End>(output, piece.cells,
                         [&](std::size_t i) { return corners * (piece.firstCell + i + 1); });
        writeValues<End>(output, piece.others->count(), [&](std::size_t i) {
          return corners * piece.cells + endOf(*piece.others, i + 1);
        });
      });
}

template <class Feature>
void addRows(VtkDataSet& data, std::string_view name, const std::vector<Feature>& features) {
  if (features.empty()) return;
  data.addOwn(VtkSection::FieldData, name, rowsOf(features), features.front().vertices.size() + 1);
}

void addNames(VtkDataSet& data, std::span<const TagName> names) {
  if (names.empty()) return;
  std::vector<std::int32_t> tags;
  for (const TagName& known : names) tags.insert(tags.end(), {known.dimension, known.tag});
  data.addTexts(kVtkTagNames, names);
  data.addOwn(VtkSection::FieldData, kVtkNamedTags, std::move(tags), 2);
}

template <class AnyFeatures, class Face>
void addTagsOf(VtkDataSet& data, const AnyFeatures& features, std::string_view faceTags,
               const std::vector<Face>& faces, std::span<const std::int32_t> regions) {
  addNames(data, features.names);
  addRows(data, kVtkEdgeTags, features.edges);
  addRows(data, faceTags, faces);
  if (!features.vertices.empty()) {
    data.addOwn(VtkSection::PointData, kVtkVertexTags, vertexTags(features.vertices, data.points));
  }
  if (!regions.empty()) data.add(VtkSection::CellData, kVtkRegions, regions);
}

}  // namespace

void VtkDataSet::addTexts(std::string_view name, std::span<const TagName> names) {
  std::string all;
  for (const TagName& known : names) {
    all.append(known.name, 0, known.name.find('\0')).push_back('\0');
  }
  const std::uint64_t bytes = all.size();
  arrays_.insert(arrays_.begin(),
                 {VtkSection::FieldData, name, typeName<std::uint8_t>(), 1, bytes, bytes,
                  [own = std::move(all)](const VtkBytes& out) { out(own.data(), own.size()); }});
}

Index cornerOf(const OtherCells& others, std::size_t i) {
  const OtherCellList* kind = others.kinds.data();
  for (; i >= kind->vertices.size(); ++kind) i -= kind->vertices.size();
  return kind->vertices[i];
}

std::size_t endOf(const OtherCells& others, std::size_t i) {
  std::size_t end = 0;
  for (const OtherCellList& kind : others.kinds) {
    const std::size_t ofKind = std::min(i, kind.count());
    end += kind.corners * ofKind;
    i -= ofKind;
  }
  return end;
}

VtkDataSet meshDataSet(const VtkPiece& piece, std::uint64_t points, std::uint64_t cells,
                       std::size_t corners, std::uint8_t type) {
  VtkDataSet data(points, cells + piece.others->count());
  const std::span lists(&piece.vertices, 1);
  if (!piece.vertices.generatorCorners.empty()) {
    addGeneratorKinds(data, lists);
    addGeneratorCorners(data, lists);
  }
  if (!piece.vertices.generatorTet.empty()) addGeneratorTets(data, lists);
  addCoordinates(data, lists);
  // Use signed integers of 32 bits, since all readers accept those.
  constexpr std::uint64_t kLargestInt32 = std::numeric_limits<std::int32_t>::max();
  const auto addCornersAs =
      points > kLargestInt32 ? addCorners<std::int64_t> : addCorners<std::int32_t>;
  addCornersAs(data, piece, corners);
  const auto addEndsAs =
      data.cells > kLargestInt32 / corners ? addEnds<std::int64_t> : addEnds<std::int32_t>;
  addEndsAs(data, piece, corners);
  data.add<std::uint8_t>(
      VtkSection::Cells, "types", 1, data.cells, [&piece, type](const VtkBytes& output) {
        writeValues<std::uint8_t>(output, piece.cells, [type](std::size_t) { return type; });
        for (const OtherCellList& kind : piece.others->kinds) {
          const std::int64_t other = typeWith(kind.corners).vtkType;
          writeValues<std::uint8_t>(output, kind.count(), [other](std::size_t) { return other; });
        }
      });
  return data;
}

void addPoints(VtkDataSet& data, std::span<const PointPiece> lists) {
  addCoordinates(data, lists);
  addGeneratorTets(data, lists);
  addGeneratorCorners(data, lists);
  addGeneratorKinds(data, lists);
}

void addTags(VtkDataSet& data, const HexFeatures& features, std::span<const std::int32_t> regions) {
  addTagsOf(data, features, kVtkQuadTags, features.quads, regions);
}

void addTags(VtkDataSet& data, const Features& features, std::span<const std::int32_t> regions) {
  addTagsOf(data, features, kVtkTriangleTags, features.faces, regions);
}

VtkDataSet hexDataSet(const HexMesh& mesh, const WriteOptions& options, VtkPiece& piece) {
  piece.vertices = {0, mesh.points, mesh.generatorTet, mesh.generatorCorners};
  piece.setCells(0, std::span<const Hex>(mesh.cells));
  piece.others = &othersOf(options);
  VtkDataSet data = meshDataSet(piece, mesh.points.size(), mesh.cells.size(),
                                std::tuple_size_v<Hex>, kVtkHexahedron);
  const bool mixed = piece.others->count() > 0;
  if (!mixed) data.add(VtkSection::CellData, kVtkQuality, options.scaledJacobians);
  addTags(data, mesh.features, mixed ? std::span<const std::int32_t>() : mesh.regions);
  if (!mixed) return data;
  addRows(data, kVtkTriangleTags, piece.others->triangles);
  Array<std::int32_t> regions = AllCells(mesh, *piece.others).regions();
  if (!regions.empty()) data.addOwn(VtkSection::CellData, kVtkRegions, std::move(regions));
  return data;
}

VtkDataSet partDataSet(const MeshPart& part, const PartsInfo& info, VtkPiece& piece) {
  const HexMesh& mesh = part.mesh;
  const std::size_t points = mesh.points.size();
  const std::size_t cells = mesh.cells.size();
  piece.vertices = {0, mesh.points, mesh.generatorTet, mesh.generatorCorners};
  piece.setCells(0, std::span<const Hex>(mesh.cells));
  VtkDataSet data = meshDataSet(piece, points, cells, std::tuple_size_v<Hex>, kVtkHexahedron);
  constexpr VtkSection kOfPoints = VtkSection::PointData;
  constexpr VtkSection kOfCells = VtkSection::CellData;
  if (mesh.generatorCorners.empty()) {
    data.addOwn(kOfPoints, "generator_kind", std::vector<std::uint8_t>(points, 0));
    data.addOwn(kOfPoints, kVtkGeneratorCorners, std::vector<std::uint8_t>(points, 0));
    data.addOwn(kOfPoints, kVtkGeneratorTets, std::vector<std::uint32_t>(points, 0));
  }
  addTags(data, mesh.features, {});
  if (!info.vertexTags.empty() && mesh.features.vertices.empty()) {
    data.addOwn(kOfPoints, kVtkVertexTags, std::vector<std::int32_t>(points, 0));
  }
  if (!info.regions.empty()) {
    data.add(kOfCells, kVtkRegions, std::span<const std::int32_t>(mesh.regions));
  }
  const auto number = [&data](VtkSection section, std::string_view name,
                              const Array<std::uint64_t>& numbers) {
    data.addComputed<std::int64_t>(section, name, numbers.size(),
                                   [&numbers](std::size_t i) { return numbers[i]; });
  };
  number(kOfPoints, kVtkGlobalPoints, part.globalPoints);
  number(kOfCells, kVtkGlobalCells, part.globalCells);
  if (info.ghostLayers == 0) return data;
  data.addComputed<std::uint8_t>(kOfPoints, kVtkGhosts, points, [&part](std::size_t i) {
    return part.pointOwners[i] == part.part ? 0 : kVtkDuplicate;
  });
  data.addComputed<std::uint8_t>(kOfCells, kVtkGhosts, cells, [&part](std::size_t i) {
    return i < part.ownCells ? 0 : kVtkDuplicate;
  });
  return data;
}

}  // namespace hexhex::io
