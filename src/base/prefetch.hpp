// Memory that will be asked for soon.
#pragma once

namespace hexhex {

/// Tells the processor to fetch what is there into its cache, for reading. Where compilers have no
/// word for that, nothing happens.
inline void prefetch([[maybe_unused]] const void* memory) noexcept {
#if defined(__GNUC__)
  __builtin_prefetch(memory);
#endif
}

}  // namespace hexhex
