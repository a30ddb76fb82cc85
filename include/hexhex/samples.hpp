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
  Star,         ///< column with one inner edge of arbitrary valence, at least 3
  Tetrahedron,  ///< 4 blocks, four edges of valence 3 that meet in the centre
  Torus,        ///< solid torus (genus 1), O-grid section
  Shell,        ///< spherical shell, 6 blocks: a cavity, two boundary components
  HandleBody    ///< plate with holes, genus 2
};

enum class ChartStyle {
  Aligned,  ///< one frame per block, rotated so that as many transitions as possible are identities
  Blocks,   ///< a random rotation and integer translation per block
  Random,   ///< a random rotation and integer translation per tet, and a random (even) permutation
            ///< of its corners: hardly any identity remains
  Scattered  ///< Random for one tet in eight, Aligned for the others
};

/// Which vertices to move in order to damage a sample, and how.
enum class DefectKind {
  Interior,  ///< inner vertices, so that tets flip
  Singular,  ///< vertices on inner and boundary singular edges, along these edges
  Boundary,  ///< vertices on the boundary, within its planes
  Sliver     ///< inner vertices, onto or between others, so that tets collapse
};

struct SampleOptions {
  int cells = 4;    ///< hexahedra along each block edge, 1 to 10000
  int refine = 2;   ///< tet sub-blocks along each block edge, 1 to 500 (12 tets per sub-block)
  int valence = 5;  ///< of SampleKind::Star, 3 to 12
  ChartStyle charts = ChartStyle::Aligned;
  double jitter = 0;  ///< displaces free tet vertices by up to this fraction of a sub-block, 0 to 1
  double onLattice = 0;  ///< fraction of free tet coordinates placed exactly on integers, 0 to 1
  double noise = 0;  ///< added to each corner independently, uniform in [-noise, noise]; below 0.25
                     ///< and at most cells / (72 refine), so that the answer remains correct
  double offset = 0;  ///< chart translations are integers in [-offset, offset], up to 1e9; one for
                      ///< all blocks if aligned. Below 1: none if aligned, else up to 20
  /// Makes the map seamless instead of integer: along each chain of opposite block edges, hexahedra
  /// get a random length from [1 - stretch, 1 + stretch). 0 to 0.9, not with jitter or onLattice.
  /// The answer is that of the unstretched map.
  double stretch = 0;
  /// Tags corners, sharp and singular curves, and the smooth boundary patches between them, each
  /// kind starting at 1, and numbers the blocks as regions, starting at 1.
  bool features = false;
  std::uint64_t seed = 1;
  int defects = 0;  ///< damages one place: at least this many tets are flipped or flat, if the
                    ///< sample has enough vertices of the kind; 0 to 10000. 0: a valid map
  DefectKind defectKind = DefectKind::Interior;
};

/// Expected tags in the mesh of a sample. At scale s, there are s times as many edges and s^2 times
/// as many quads.
struct FeatureAnswer {
  std::map<std::int32_t, std::uint64_t> vertices;  ///< hex vertices at corners: 1 each
  std::map<std::int32_t, std::uint64_t> edges;     ///< hex edges on each curve
  std::map<std::int32_t, std::uint64_t> quads;     ///< hex faces on each patch
  std::uint64_t regions = 0;                       ///< number of blocks
};

/// Known properties of the mesh of a sample.
struct SampleAnswer {
  Expectation expected;
  std::uint64_t vertices = 0;  ///< number of hex vertices
  FeatureAnswer features;      ///< empty without SampleOptions::features
};

struct Sample {
  TetMap map;
  SampleAnswer answer;  ///< at scale 1
};

/// A kind of sample and its name on the command line ("box", "cylinder", ...).
struct SampleKindName {
  SampleKind kind;
  std::string_view name;
  std::string_view description;
};
[[nodiscard]] std::span<const SampleKindName> sampleKinds() noexcept;

/// A chart style and its name on the command line ("aligned", ...).
struct ChartStyleName {
  ChartStyle kind;
  std::string_view name;
};
[[nodiscard]] std::span<const ChartStyleName> chartStyles() noexcept;

/// A kind of defect and its name on the command line ("interior", ...).
struct DefectKindName {
  DefectKind kind;
  std::string_view name;
};
[[nodiscard]] std::span<const DefectKindName> defectKinds() noexcept;

/// Generates a map. The same options yield the same map on every machine. The answer refers to the
/// undamaged map.
/// @throws Error InvalidArgument; TooLarge for more tets than 32-bit indices can number;
///         OutOfMemory
[[nodiscard]] Sample generateSample(SampleKind kind, const SampleOptions& options = {});

}  // namespace HEXHEX_API_NAMESPACE
