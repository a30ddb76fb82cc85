// What compilers do not do by themselves: conditions without branches, where processors could not
// predict them, and prefetching.
#pragma once

namespace hexhex {

/// Whether all conditions hold; evaluates every one.
template <class... Bools>
[[nodiscard]] constexpr bool allOf(Bools... conditions) noexcept {
  return (static_cast<unsigned>(conditions) & ...) != 0;
}

[[nodiscard]] constexpr bool hasManyBits(unsigned bits) noexcept {
  return (bits & (bits - 1)) != 0;
}
/// std::has_single_bit is a function call where processors may lack a popcount instruction.
[[nodiscard]] constexpr bool hasOneBit(unsigned bits) noexcept {
  return bits != 0 && !hasManyBits(bits);
}

/// Prefetches memory for reading. Does nothing where compilers have no builtin for it.
inline void prefetch([[maybe_unused]] const void* memory) noexcept {
#if defined(__GNUC__)
  __builtin_prefetch(memory);
#endif
}

}  // namespace hexhex
