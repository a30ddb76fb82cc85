#include <array>
#include <vector>

#include <map/map_volume.hpp>

namespace hexhex {

namespace {

/// The volume of a tet is the sum of those between its faces and the origin. They cancel at inner
/// faces, but for what the transition makes of it: if it is a translation by t after a rotation,
/// then the scalar product of t with the triangle's normal is left.
class VolumeSum {
 public:
  explicit VolumeSum(const ExactMap& map) : map_(map) {}

  /// A triangle in an axis-parallel plane has a normal along that axis.
  void addBoundary(const PlainVertices::BoundaryFace& face) {
    const Triangle triangle = triangleOf(face.halfFace);
    // Outward normals are the negative ones.
    add(crossComponent(triangle.a, triangle.b, face.axis), -triangle.origin[face.axis]);
  }

  void addInner(HalfFace halfFace) {
    const Transitions& transitions = map_.transitions;
    const Index back = Transitions::inverse(transitions.jump[halfFace]);
    const GridPoint& translation = transitions.table[back].translation;
    const Triangle triangle = triangleOf(halfFace);
    for (std::size_t k = 0; k < 3; ++k) {
      add(crossComponent(triangle.a, triangle.b, k), -translation[k] * map_.unit);
    }
  }

  [[nodiscard]] const Int192& get() const noexcept { return sum_; }

 private:
  struct Triangle {
    LatticePoint origin;
    LatticePoint a;  ///< from the origin to the second corner
    LatticePoint b;
  };
  [[nodiscard]] Triangle triangleOf(HalfFace halfFace) const {
    const LatticeTet& corners = map_.corners[tetOf(halfFace)];
    const std::array<int, 3>& face = kFaceCorners[halfFace % 4];
    const LatticePoint& origin = corners[static_cast<std::size_t>(face[0])];
    return {origin, corners[static_cast<std::size_t>(face[1])] - origin,
            corners[static_cast<std::size_t>(face[2])] - origin};
  }

  /// Adds a product. The sign of a factor is as good as random, and made positive without a branch.
  void add(Int128 a, std::int64_t b) {
    const std::int64_t sign = b >> 63;  // 0 or -1
    sum_.addProduct((a ^ sign) - sign, (b ^ sign) - sign);
  }

  const ExactMap& map_;
  Int192 sum_;
};

void addAll(std::span<const Int192> volumes, Int192& sum) {
  for (const Int192& volume : volumes) sum += volume;
}

}  // namespace

void addVolume(const PlainVertices& plain, Stage& stage, ExactMap& map) {
  const std::size_t blocks = plain.boundaryFaces.size();
  std::vector<Int192> volumes(blocks);
  parallelFor(stage, blocks, 1, [&](std::size_t block) {
    VolumeSum sum(map);
    for (const PlainVertices::BoundaryFace& face : plain.boundaryFaces[block]) {
      sum.addBoundary(face);
    }
    for (const HalfFace halfFace : plain.unequalFaces[block]) sum.addInner(halfFace);
    volumes[block] = sum.get();
  });
  addAll(volumes, map.sixfoldVolume);
}

void addVolume(const RoundedTets& rounded, Stage& stage, ExactMap& map) {
  std::vector<Int192> volumes(rounded.unfinished.size());
  parallelFor(stage, volumes.size(), 1, [&](std::size_t block) {
    for (const Index t : rounded.unfinished[block]) {
      const LatticeTet& c = map.corners[t];
      volumes[block] += orientationDeterminant(c[0], c[1], c[2], c[3]);
    }
  });
  map.sixfoldVolume += rounded.sixfoldVolume;
  addAll(volumes, map.sixfoldVolume);
}

}  // namespace hexhex
