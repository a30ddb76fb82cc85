// Which tets of a map that is not valid can be used, and where one can go on to the next.
#pragma once

#include <cstdint>
#include <vector>

#include <igm/input.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

/// Whether transitions carry the three lattice corners of an inner triangle over.
[[nodiscard]] bool isCarriedOver(const PreparedMap& map, HalfFace halfFace) noexcept;

/// Per tet: 1 if it is positive on the sanitized lattice and sanitization moved its corners by no
/// more than the tolerance.
[[nodiscard]] std::vector<std::uint8_t> findValidTets(const PreparedMap& map,
                                                      const LocalParameters& parameters,
                                                      double tolerance, Stage& stage);

}  // namespace hexhex
