// Random block structures: hexahedra glued face to face, each of which becomes a block of cells.
#pragma once

#include <string>

#include <base/random.hpp>
#include <samples/block_complex.hpp>
#include <samples/kinds.hpp>

namespace hexhex::campaign {

/// Not that of the tests, which draws otherwise.
using hexhex::Random;

/// Mostly small things are drawn: they are fast, and large ones find little that they do not.
inline std::uint64_t oftenOr(std::uint64_t usual, std::uint64_t rare, Random& random) {
  return random.below(4) > 0 ? usual : rare;
}

struct BlockStructure {
  std::string kind;  ///< of structure, for statistics
  samples::BlockModel model;
};

/// Whether the blocks around every edge form one fan or ring and those around every vertex one ball
/// or half-ball, so that the tets of the blocks will; and all cells have different vertices.
[[nodiscard]] bool isManifold(const samples::BlockComplex& complex);

/// Cubes that touch somehow; often not manifold.
[[nodiscard]] BlockStructure drawPolycube(Random& random);
/// Cubes glued in any way that keeps them manifold: singular edges of any valence from 2 on,
/// handles, cavities. Its shape in space means nothing.
[[nodiscard]] BlockStructure drawGluedCubes(Random& random);
/// No boundary at all: a torus of three dimensions, or the surface of a cube of four. Its shape in
/// space means nothing.
[[nodiscard]] BlockStructure drawClosedManifold(Random& random);
/// A prism over polygons cut into quads at their midpoints.
[[nodiscard]] BlockStructure drawPrism(Random& random);
/// A ring whose end is turned before it is glued to its beginning.
[[nodiscard]] BlockStructure drawTwistedRing(Random& random);
/// Tets, each of which is cut into four blocks at its midpoints.
[[nodiscard]] BlockStructure drawCutTets(Random& random);
/// The cells of a mesh that was extracted from a sample.
[[nodiscard]] BlockStructure drawHexMesh(Random& random);
/// The blocks of a sample; stars have up to 602 of them around their edge.
[[nodiscard]] BlockStructure drawSampleBlocks(Random& random);

/// Any of them, with its blocks turned at random or not.
[[nodiscard]] BlockStructure drawBlockStructure(Random& random);

}  // namespace hexhex::campaign
