#include <algorithm>

#include <quantize/polycube/labelled_mesh.hpp>

#include <base/vector3.hpp>
#include <igm/defects.hpp>

namespace hexhex::quantization {

namespace {

/// Uses positions as parameters to reuse the checks of maps; the map then has the object's
/// orientation.
igm::OrientedMap readTets(const TetMesh& tets, Stage& stage) {
  std::vector<TetParameters> positions;
  positions.reserve(tets.tets.size());
  for (const Tet& tet : tets.tets) {
    TetParameters& corners = positions.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      if (tet[i] < tets.points.size()) corners[i] = tets.points[tet[i]];
    }
  }
  igm::DefectCollector defects;
  TetMapView view{tets.points, tets.tets, positions};
  view.features = tets.features;
  view.regions = tets.regions;
  igm::OrientedMap input = igm::readInput(view, stage, defects);
  defects.throwIfAny();
  input.view.parameters = {};
  input.parameters = {};
  return input;
}

/// Tets whose sixfold volume is at most this, relative to the cube of the longest edge, are
/// considered flat, as rounding could explain it. Slivers in practice have 1e-3 to 1e-8.
constexpr double kFlat = 1e-12;

/// Called before neighbours are compared: with a tet whose corners are in the wrong order, that
/// comparison would not tell which of the two is at fault.
void requirePositive(const TetMapView& view) {
  std::size_t count = 0;
  Index first = 0;
  for (std::size_t t = view.tets.size(); t > 0;) {
    --t;
    const Tet& tet = view.tets[t];
    const auto edge = [&](std::size_t i) {
      return minus(view.points[tet[i]], view.points[tet[0]]);
    };
    double longest = 0;
    for (std::size_t i = 1; i < 4; ++i) longest = std::max(longest, length(edge(i)));
    const double volume = tripleProduct(edge(1), edge(2), edge(3));
    if (volume > kFlat * longest * longest * longest) continue;
    ++count;
    first = static_cast<Index>(t);
  }
  if (count == 0) return;
  const std::string others = count == 1 ? "" : ", and " + std::to_string(count - 1) + " more are";
  throw Error(ErrorCode::FlippedTet,
              "Tet " + std::to_string(first) + " of the mesh is inside out or flat" + others +
                  ". Swap two of its corners (and their labels) if they are listed in another "
                  "order than those of its neighbours; otherwise move its vertices, or mesh the "
                  "object again.",
              {PlaceKind::Tet, first});
}

void requireLabel(const LabelledMesh& mesh, adjacency::HalfFace h) {
  const std::int8_t flag = mesh.flags[h];
  const bool isBoundary = mesh.topology.isBoundary(h);
  if (flag < -1 || flag > 5) {
    refuseFlag(mesh, h,
               "A label is " + std::to_string(flag) +
                   "; labels are 0 to 5 for +x -x +y -y +z -z, and -1 inside.");
  }
  if (isBoundary && flag < 0) {
    refuseFlag(mesh, h, "A boundary triangle has no label; each needs one from 0 to 5.");
  }
  if (!isBoundary && flag >= 0) {
    refuseFlag(mesh, h, "A triangle inside of the object has a label; only the boundary has.");
  }
}

}  // namespace

void refuseFlag(const LabelledMesh& mesh, adjacency::HalfFace h, const std::string& sentence) {
  throw Error(ErrorCode::InvalidArgument, sentence, mesh.placeOf(h));
}

LabelledMesh readUnlabelled(const TetMesh& tets, Stage& stage) {
  LabelledMesh mesh;
  mesh.input = readTets(tets, stage);
  requirePositive(mesh.input.view);
  igm::DefectCollector defects;
  mesh.topology = igm::buildTopology(mesh.input.view, stage, defects);
  defects.throwIfAny();
  adjacency::addStars(mesh.topology, stage);
  return mesh;
}

LabelledMesh readLabels(const TetMesh& tets, std::span<const FaceFlags> flags, Stage& stage) {
  if (flags.size() != tets.tets.size()) {
    throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(flags.size()) +
                                                " labels of four faces, but " +
                                                std::to_string(tets.tets.size()) + " tets.");
  }
  LabelledMesh mesh = readUnlabelled(tets, stage);
  mesh.flags.resize(mesh.topology.mate.size());
  for (adjacency::HalfFace h = 0; h < mesh.flags.size(); ++h) {
    const auto face = static_cast<std::size_t>(mesh.input.callersCorner(adjacency::localOf(h)));
    mesh.flags[h] = flags[adjacency::tetOf(h)][face];
    requireLabel(mesh, h);
  }
  return mesh;
}

}  // namespace hexhex::quantization
