#include <limits>
#include <string>

#include <hexhex/error.hpp>

#include <io/vtk/vtk_data_set.hpp>

namespace hexhex {
namespace {

/// A tag for each vertex, 0 without.
/// @throws Error InvalidArgument for a vertex that does not exist
Array<std::int32_t> vertexTags(const std::vector<FeatureVertex>& features, std::size_t vertices) {
  Array<std::int32_t> tags(vertices);
  std::fill(tags.begin(), tags.end(), 0);
  for (const FeatureVertex& feature : features) {
    if (feature.vertex < tags.size()) {
      tags[feature.vertex] = feature.tag;
      continue;
    }
    throw Error(ErrorCode::InvalidArgument, "A feature names vertex " +
                                                std::to_string(feature.vertex) +
                                                ", which is not one of the mesh.");
  }
  return tags;
}

/// Elements as rows of numbers: the vertices and the tag.
template <class Feature>
std::vector<std::int64_t> rowsOf(const std::vector<Feature>& features) {
  std::vector<std::int64_t> rows;
  for (const Feature& feature : features) {
    rows.insert(rows.end(), feature.vertices.begin(), feature.vertices.end());
    rows.push_back(feature.tag);
  }
  return rows;
}

/// What a piece has in memory.
/// @tparam T  the number type
template <class T, class Value>
void addPart(VtkDataSet& data, VtkSection section, std::string_view name, std::size_t components,
             const VtkPiece& piece, std::span<const Value> VtkPiece::*part) {
  data.add<T>(section, name, components, data.points, [&piece, part](const VtkBytes& output) {
    output((piece.*part).data(), (piece.*part).size_bytes());
  });
}

/// @tparam Corner  the number type in the file
template <class Corner>
void addCorners(VtkDataSet& data, const VtkPiece& piece, std::uint64_t count) {
  data.add<Corner>(VtkSection::Cells, "connectivity", 1, count, [&piece](const VtkBytes& output) {
    const auto write = [&output](const auto& corners) {
      // Indices that fit have the same bytes with and without a sign.
      if (sizeof(Corner) == sizeof(corners[0])) {
        output(corners.data(), corners.size_bytes());
      } else {
        writeValues<Corner>(output, corners.size(), [&](std::size_t i) { return corners[i]; });
      }
    };
    if (!piece.wideCorners.empty()) return write(piece.wideCorners);
    write(piece.corners);
  });
}

/// @tparam End  the number type in the file
template <class End>
void addEnds(VtkDataSet& data, const VtkPiece& piece, std::size_t corners) {
  data.add<End>(
      VtkSection::Cells, "offsets", 1, data.cells, [&piece, corners](const VtkBytes& output) {
        writeValues<End>(output, piece.cells,
                         [&](std::size_t i) { return corners * (piece.firstCell + i + 1); });
      });
}

template <class Feature>
void addRows(VtkDataSet& data, std::string_view name, const std::vector<Feature>& features) {
  if (features.empty()) return;
  data.addOwn(VtkSection::FieldData, name, rowsOf(features), features.front().vertices.size() + 1);
}

template <class AnyFeatures, class Face>
void addTagsOf(VtkDataSet& data, const AnyFeatures& features, std::string_view faceTags,
               const std::vector<Face>& faces, std::span<const std::int32_t> regions) {
  addRows(data, kVtkEdgeTags, features.edges);
  addRows(data, faceTags, faces);
  if (!features.vertices.empty()) {
    data.addOwn(VtkSection::PointData, kVtkVertexTags, vertexTags(features.vertices, data.points));
  }
  if (!regions.empty()) data.add(VtkSection::CellData, kVtkRegions, regions);
}

}  // namespace

VtkDataSet meshDataSet(const VtkPiece& piece, std::uint64_t points, std::uint64_t cells,
                       std::size_t corners, std::uint8_t type) {
  VtkDataSet data(points, cells);
  if (!piece.generatorCorners.empty()) {
    data.add<std::uint8_t>(
        VtkSection::PointData, "generator_kind", 1, points, [&piece](const VtkBytes& output) {
          writeValues<std::uint8_t>(output, piece.generatorCorners.size(), [&](std::size_t i) {
            return generatorKind(piece.generatorCorners[i]);
          });
        });
    addPart<CornerSet>(data, VtkSection::PointData, kVtkGeneratorCorners, 1, piece,
                       &VtkPiece::generatorCorners);
  }
  if (!piece.generatorTets.empty()) {
    addPart<Index>(data, VtkSection::PointData, kVtkGeneratorTets, 1, piece,
                   &VtkPiece::generatorTets);
  }
  addPart<double>(data, VtkSection::Points, "Points", 3, piece, &VtkPiece::points);
  // 32-bit numbers are signed, since every reader takes those.
  constexpr std::uint64_t kLargestInt32 = std::numeric_limits<std::int32_t>::max();
  const auto addCornersAs =
      points > kLargestInt32 ? addCorners<std::int64_t> : addCorners<std::int32_t>;
  addCornersAs(data, piece, corners * cells);
  const auto addEndsAs =
      cells > kLargestInt32 / corners ? addEnds<std::int64_t> : addEnds<std::int32_t>;
  addEndsAs(data, piece, corners);
  data.add<std::uint8_t>(
      VtkSection::Cells, "types", 1, cells, [&piece, type](const VtkBytes& output) {
        writeValues<std::uint8_t>(output, piece.cells, [type](std::size_t) { return type; });
      });
  return data;
}

void addTags(VtkDataSet& data, const HexFeatures& features, std::span<const std::int32_t> regions) {
  addTagsOf(data, features, kVtkQuadTags, features.quads, regions);
}

void addTags(VtkDataSet& data, const Features& features, std::span<const std::int32_t> regions) {
  addTagsOf(data, features, kVtkTriangleTags, features.faces, regions);
}

VtkDataSet hexDataSet(const HexMesh& mesh, std::span<const double> quality, VtkPiece& piece) {
  piece = {.points = mesh.points,
           .generatorTets = mesh.generatorTet,
           .generatorCorners = mesh.generatorCorners};
  piece.setCells(0, std::span<const Hex>(mesh.cells));
  VtkDataSet data = meshDataSet(piece, mesh.points.size(), mesh.cells.size(),
                                std::tuple_size_v<Hex>, kVtkHexahedron);
  data.add(VtkSection::CellData, "scaled_jacobian", quality);
  addTags(data, mesh.features, mesh.regions);
  return data;
}

}  // namespace hexhex
