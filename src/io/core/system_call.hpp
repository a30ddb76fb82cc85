// Functions of the system, which a signal may interrupt.
#pragma once

#include <cerrno>

namespace hexhex {

/// Calls a function of the system again if a signal interrupted it.
/// @param call  returns a negative number if it fails
template <class Call>
auto uninterrupted(const Call& call) {
  while (true) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

}  // namespace hexhex
