// Vertices with stars that are flat in the picture that gauges show.
#pragma once

#include <vector>

#include <map/gauges.hpp>
#include <map/local_parameters.hpp>
#include <map/plain_vertices.hpp>
#include <map/vertex_star.hpp>

namespace hexhex {

/// Makes vertices plain again that are special only because charts differ, in passes over tets and
/// without a look at stars: those where all gauges around agree across transitions that are exact.
/// The gauges then bring the star into one picture, in which the cones of its tets must cover one
/// direction once, as in PlainVertices; and what is said of flat stars (flat_stars.hpp) holds. Only
/// rotations are needed: across an exact transition the parameters of common corners fit, so
/// relative to the vertex there is nothing to translate. Where rounding could matter, or where
/// gauges do not agree, a vertex stays special.
/// @param plain  knows the passages of transitions; loses special vertices
/// @return the corners of those on the boundary, in blocks that have nothing else
[[nodiscard]] std::vector<StarBlock> unfoldVertices(const TetTopology& topology,
                                                    const LocalParameters& parameters,
                                                    const Gauges& gauges, PlainVertices& plain,
                                                    Stage& stage);

}  // namespace hexhex
