// Includes all headers.
#pragma once

#include <hexhex/base_complex.hpp>   // IWYU pragma: export
#include <hexhex/check.hpp>          // IWYU pragma: export
#include <hexhex/context.hpp>        // IWYU pragma: export
#include <hexhex/curved.hpp>         // IWYU pragma: export
#include <hexhex/error.hpp>          // IWYU pragma: export
#include <hexhex/extract.hpp>        // IWYU pragma: export
#include <hexhex/extractor.hpp>      // IWYU pragma: export
#include <hexhex/features.hpp>       // IWYU pragma: export
#include <hexhex/fields.hpp>         // IWYU pragma: export
#include <hexhex/fill.hpp>           // IWYU pragma: export
#include <hexhex/improve.hpp>        // IWYU pragma: export
#include <hexhex/io.hpp>             // IWYU pragma: export
#include <hexhex/map_structure.hpp>  // IWYU pragma: export
#include <hexhex/mesh.hpp>           // IWYU pragma: export
#include <hexhex/partial.hpp>        // IWYU pragma: export
#include <hexhex/parts.hpp>          // IWYU pragma: export
#include <hexhex/patches.hpp>        // IWYU pragma: export
#include <hexhex/quality.hpp>        // IWYU pragma: export
#include <hexhex/quantize.hpp>       // IWYU pragma: export
#include <hexhex/repair.hpp>         // IWYU pragma: export
#include <hexhex/samples.hpp>        // IWYU pragma: export
#include <hexhex/shape.hpp>          // IWYU pragma: export
#include <hexhex/stream.hpp>         // IWYU pragma: export
#include <hexhex/structure.hpp>      // IWYU pragma: export
#include <hexhex/summary.hpp>        // IWYU pragma: export
#include <hexhex/team.hpp>           // IWYU pragma: export
#include <hexhex/types.hpp>          // IWYU pragma: export
#include <hexhex/verify.hpp>         // IWYU pragma: export
#include <hexhex/version.hpp>        // IWYU pragma: export
