#include <array>
#include <vector>

#include <igm/map_volume.hpp>

namespace hexhex {

namespace {

/// The volume of a tet is the sum of those between its faces and the origin. They cancel at inner
/// faces, but for what the transition makes of it: if it is a translation by t after a rotation,
/// then the scalar product of t with the triangle's normal is left.
class VolumeSum {
 public:
  explicit VolumeSum(const ExactMap& map) : map_(map) {}

  /// A triangle in an axis-parallel plane has a normal along that axis.
  void addBoundary(const RegularVertices::BoundaryFace& face) {
    // Outward normals are the negative ones.
    const Triangle triangle(map_, face.halfFace);
    add(triangle.normal(face.axis), -triangle.p[face.axis]);
  }

  void addInner(HalfFace halfFace) {
    const Transitions& transitions = map_.transitions;
    const Index back = Transitions::inverse(transitions.ofFace[halfFace]);
    const GridPoint& translation = transitions.table[back].translation;
    const Triangle triangle(map_, halfFace);
    for (std::size_t k = 0; k < 3; ++k) add(triangle.normal(k), -translation[k] * map_.unit);
  }

  [[nodiscard]] Int192 get() const noexcept {
    Int192 sum(static_cast<Int128>(lowSum_));
    sum.addProduct(static_cast<Int128>(highSum_), std::int64_t{1} << kLowBits);
    return sum;
  }

 private:
  struct Triangle {
    const LatticePoint& p;
    const LatticePoint& q;
    const LatticePoint& r;

    Triangle(const ExactMap& map, HalfFace halfFace)
        : Triangle(map.corners[tetOf(halfFace)], kFaceCorners[halfFace % 4]) {}
    Triangle(const LatticeTet& corners, const std::array<int, 3>& face)
        : p(corners[static_cast<std::size_t>(face[0])]),
          q(corners[static_cast<std::size_t>(face[1])]),
          r(corners[static_cast<std::size_t>(face[2])]) {}

    /// A component of (q - p) x (r - p); by a table, as axes cannot be predicted.
    [[nodiscard]] Int128 normal(std::size_t axis) const noexcept {
      constexpr std::array<std::uint8_t, 5> kAxes = {0, 1, 2, 0, 1};
      const std::size_t i = kAxes[axis + 1];
      const std::size_t j = kAxes[axis + 2];
      return static_cast<Int128>(q[i] - p[i]) * (r[j] - p[j]) -
             static_cast<Int128>(q[j] - p[j]) * (r[i] - p[i]);
    }
  };

  /// Adds a product, of a's lower and upper part apart: of a valid map, coordinates are below 2^52,
  /// normals below 2^107 and translations below 2^53, so that neither sum overflows with
  /// less than 2^14 products. (Of others, they may.)
  void add(Int128 a, std::int64_t b) {
    const auto low = static_cast<std::int64_t>(a) & ((std::int64_t{1} << kLowBits) - 1);
    const auto high = static_cast<std::int64_t>(a >> kLowBits);
    lowSum_ += static_cast<UInt128>(static_cast<Int128>(low) * b);
    highSum_ += static_cast<UInt128>(static_cast<Int128>(high) * b);
  }

  static constexpr int kLowBits = 56;
  static_assert(RegularVertices::kBlock <=
                1024);  // so many tets have at most 4 * 3 * 1024 products

  const ExactMap& map_;
  UInt128 lowSum_ = 0;
  UInt128 highSum_ = 0;
};

void addAll(std::span<const Int192> volumes, Int192& sum) {
  for (const Int192& volume : volumes) sum += volume;
}

}  // namespace

void addVolume(const RegularVertices& survey, Stage& stage, ExactMap& map) {
  const std::size_t blocks = survey.boundaryFaces.size();
  std::vector<Int192> volumes(blocks);
  parallelFor(stage, blocks, 1, [&](std::size_t block) {
    VolumeSum sum(map);
    for (const RegularVertices::BoundaryFace& face : survey.boundaryFaces[block]) {
      sum.addBoundary(face);
    }
    for (const HalfFace halfFace : survey.unequalFaces[block]) sum.addInner(halfFace);
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
