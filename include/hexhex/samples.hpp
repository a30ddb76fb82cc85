// Integer-grid maps with known answers, generated from block structures.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string_view>

#include <hexhex/check.hpp>
#include <hexhex/export.h>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

enum class SampleKind {
  Box,          ///< 2 x 2 x 2 blocks, regular
  Cylinder,     ///< 5-block O-grid, four inner edges of valence 3
  Sphere,       ///< 7-block O-grid, valence 3 along the inner cube's edges and its rays
  Star,         ///< column with one inner edge of any valence from 3
  Tetrahedron,  ///< 4 blocks, four edges of valence 3 that meet in the centre
  Torus,        ///< solid torus (genus 1), O-grid section
  Shell,        ///< spherical shell, 6 blocks: a cavity, two boundary components
  HandleBody    ///< plate with holes, genus 2
};

enum class ChartStyle {
  Aligned,   ///< one frame per block, turned so that as many transitions as possible are identities
  Blocks,    ///< a random rotation and integer translation per block
  Random,    ///< a random rotation and integer translation per tet, and a random (even) order of
             ///< its corners: hardly any identity is left
  Scattered  ///< Random for one tet in eight, Aligned for the others
};

/// Which vertices are moved to damage a sample, and how.
enum class DefectKind {
  Interior,  ///< inner vertices, so that tets flip
  Singular,  ///< vertices on inner and boundary singular edges, along them
  Boundary,  ///< vertices on the boundary, in its planes
  Sliver     ///< inner vertices, onto others or between them, so that tets collapse
};

struct SampleOptions {
  int cells = 4;    ///< hexahedra along each block edge, 1 to 10000
  int refine = 2;   ///< tet sub-blocks along each block edge, 1 to 500 (12 tets per sub-block)
  int valence = 5;  ///< of SampleKind::Star, 3 to 12
  ChartStyle charts = ChartStyle::Aligned;
  double jitter = 0;     ///< moves free tet vertices by up to this share of a sub-block, 0 to 1
  double onLattice = 0;  ///< share of free tet coordinates put exactly on integers, 0 to 1
  double noise = 0;   ///< added to every corner on its own, uniform in [-noise, noise]; below 0.25
                      ///< and at most cells / (72 refine), so that the answer stays true
  double offset = 0;  ///< chart translations are integers from [-offset, offset], up to 1e9; one
                      ///< for all blocks if aligned. Below 1: none if aligned, else up to 20
  /// Makes the map seamless instead of integer: a hexahedron gets a random length from [1 -
  /// stretch, 1 + stretch) along each chain of opposite block edges. 0 to 0.9, without jitter and
  /// onLattice. The answer is that of the map that is not stretched.
  double stretch = 0;
  /// Tags corners, sharp and singular curves, and the smooth patches of the boundary between them,
  /// each kind from 1 on, and numbers the blocks, from 1 on, as regions.
  bool features = false;
  std::uint64_t seed = 1;
  int defects = 0;  ///< damage the map in one place: at least so many tets are flipped or flat, if
                    ///< the sample has enough vertices of the kind; 0 to 10000. 0: a valid map
  DefectKind defectKind = DefectKind::Interior;
};

/// What the tags of a sample become, by tag. At scale s there are s times as many edges and s^2
/// times as many quads.
struct FeatureAnswer {
  std::map<std::int32_t, std::uint64_t> vertices;  ///< hex vertices at corners: 1 each
  std::map<std::int32_t, std::uint64_t> edges;     ///< hex edges on each curve
  std::map<std::int32_t, std::uint64_t> quads;     ///< hex faces on each patch
  std::uint64_t regions = 0;                       ///< blocks
};

/// What is known about the mesh of a sample.
struct SampleAnswer {
  Expectation expected;
  std::uint64_t vertices = 0;  ///< hex vertices
  FeatureAnswer features;      ///< empty without SampleOptions::features
};

struct Sample {
  TetMap map;
  SampleAnswer answer;  ///< at scale 1
};

/// Every kind with its name on the command line ("box", "cylinder", ...).
struct SampleKindName {
  SampleKind kind;
  std::string_view name;
  std::string_view description;
};
[[nodiscard]] std::span<const SampleKindName> sampleKinds() noexcept;

/// Every style of charts with its name on the command line ("aligned", ...).
struct ChartStyleName {
  ChartStyle kind;
  std::string_view name;
};
[[nodiscard]] std::span<const ChartStyleName> chartStyles() noexcept;

/// Every kind of defect with its name on the command line ("interior", ...).
struct DefectKindName {
  DefectKind kind;
  std::string_view name;
};
[[nodiscard]] std::span<const DefectKindName> defectKinds() noexcept;

/// Generates a map. Same options, same map, on every machine. The answer is that of the undamaged
/// map.
/// @throws Error InvalidArgument; TooLarge for more tets than 32-bit indices; OutOfMemory
[[nodiscard]] Sample generateSample(SampleKind kind, const SampleOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
