// Named boundary patches: the groups that files get, with area, centre and normal.
#include <algorithm>
#include <cmath>

#include <adjacency/corner_range.hpp>

#include <hexhex/patches.hpp>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <io/core/mesh_groups.hpp>
#include <mesh/smooth_patches.hpp>

namespace hexhex {
namespace io {
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
}  // namespace io

std::vector<NamedPatch> namedPatches(const HexMesh& mesh, double angle, Context& context) {
  mesh::requirePatchAngle(angle);
  return inStage(context, "namedPatches", "patches", [&](Stage& stage) {
    io::QuadGroups groups;
    withThreads(context.threads(), [&] {
      adjacency::requireCornersInRange(mesh, stage);
      groups = io::groupQuads(mesh, angle, stage);
    });
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
