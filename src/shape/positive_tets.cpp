#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include <quantize/polycube/labelled_mesh.hpp>
#include <shape/positive_tets.hpp>
#include <tetmap/carried_tags.hpp>
#include <tetmap/tetmap.hpp>

#include <base/stage.hpp>
#include <igm/defects.hpp>

namespace hexhex::shape {

PositiveTets::PositiveTets(const TetMesh& given) : mesh_(given), isSwapped_(given.tets.size()) {
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    Tet& tet = mesh_.tets[t];
    const auto exists = [&](Index v) { return v < mesh_.points.size(); };
    if (!std::all_of(tet.begin(), tet.end(), exists)) continue;  // reported later
    const auto edge = [&](std::size_t i) {
      return minus(mesh_.points[tet[i]], mesh_.points[tet[0]]);
    };
    isSwapped_[t] = tripleProduct(edge(1), edge(2), edge(3)) < 0;
    if (isSwapped_[t]) std::swap(tet[2], tet[3]);
  }
}

void PositiveTets::split(std::vector<tetmap::EdgeInTet> edges, Stage& stage) {
  const auto topology = adjacency::manifoldTopology(mesh_.tets, mesh_.points.size(), stage);
  assert(topology);
  const std::size_t pointCount = mesh_.points.size();
  tetmap::AddedVertices added(pointCount);
  std::vector<Index> wholes(mesh_.tets.size());  // before the splits
  std::iota(wholes.begin(), wholes.end(), Index{0});
  const auto carry = [&](const tetmap::VertexPair& edge, Index /*middle*/,
                         const std::vector<tetmap::Cut>& cuts) {
    added.add(edge);
    for (const tetmap::Cut& cut : cuts) tetmap::carryTet(cut, wholes);
  };
  static_cast<void>(tetmap::splitLongestFirst(mesh_, topology->mate, std::move(edges), carry));
  TetMap tagged{.points = std::move(mesh_.points), .tets = std::move(mesh_.tets), .parameters = {}};
  tetmap::carryTags(mesh_.features, mesh_.regions, added, wholes, tagged);
  mesh_ = {std::move(tagged.points), std::move(tagged.tets), std::move(tagged.features),
           std::move(tagged.regions)};
}

Surface readSurface(const PositiveTets& tets, Context& context) {
  Stage stage(context, "surface");
  try {
    quantization::LabelledMesh mesh = quantization::readUnlabelled(tets.mesh(), stage);
    Surface surface = surfaceOf(mesh.topology, tets.mesh().points);
    if (isManifold(surface)) return surface;
    igm::DefectCollector defects;
    igm::collectTopologyDefects(mesh.topology, stage, defects);
    defects.throwIfAny();
    throw Error(ErrorCode::Internal, "The boundary is no manifold, but the tets are.");
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Orientation) throw;
    throw Error(ErrorCode::Orientation,
                "Two tets lie on the same side of the triangle between them: one of them is folded "
                "over. Mesh the object again, or move vertices there.",
                tets.givenPlace(error.place()));
  }
}

}  // namespace hexhex::shape
