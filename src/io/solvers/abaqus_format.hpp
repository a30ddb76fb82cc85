// What the reader and the writer of `.inp` files share.
#pragma once

#include <array>

namespace hexhex::io {

/// Abaqus' numbers of the faces of kHexFaces.
inline constexpr std::array<char, 6> kAbaqusFaces = {'6', '4', '3', '5', '1', '2'};

}  // namespace hexhex::io
