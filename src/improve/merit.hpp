// Which of several improved meshes of an object is the best.
#pragma once

#include <hexhex/improve.hpp>

namespace hexhex::improvement {

/// The merit of an improved mesh: negative if a cell is not positive, 1 if nothing is left to
/// improve. A product, so that no criterion compensates for another.
[[nodiscard]] double meritOf(const ImproveReport& report);

}  // namespace hexhex::improvement
