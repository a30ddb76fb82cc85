// Who looks on while an engine works, for later stages that would have to find the same again.
#pragma once

#include <propeller/trace_guest.hpp>
#include <sweep/sweep_observer.hpp>

namespace hexhex {

/// A guest of either engine, or nullptr.
struct EngineGuests {
  SweepObserver* sweep = nullptr;  ///< of the atlas engine
  TraceGuest* trace = nullptr;     ///< of the propeller engine
};

}  // namespace hexhex
