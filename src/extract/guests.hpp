// Who looks on while an engine works, for later stages that would have to find the same again.
#pragma once

#include <sweep/sweep_guest.hpp>

#include <extract/trace_guest.hpp>

namespace hexhex {

/// A guest of either engine, or nullptr.
struct EngineGuests {
  SweepGuest* sweep = nullptr;  ///< of the atlas engine
  TraceGuest* trace = nullptr;  ///< of the propeller engine
};

}  // namespace hexhex
