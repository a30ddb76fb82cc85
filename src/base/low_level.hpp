// What compilers do not do by themselves: conditions without branches, where a processor could not
// foretell them, and fetching memory ahead.
#pragma once

namespace hexhex {

/// Whether all conditions hold; all of them are evaluated.
template <class... Bools>
[[nodiscard]] constexpr bool allOf(Bools... conditions) noexcept {
  return (static_cast<unsigned>(conditions) & ...) != 0;
}

[[nodiscard]] constexpr bool hasManyBits(unsigned bits) noexcept {
  return (bits & (bits - 1)) != 0;
}
/// std::has_single_bit is a call where processors may lack an instruction that counts bits.
[[nodiscard]] constexpr bool hasOneBit(unsigned bits) noexcept {
  return bits != 0 && !hasManyBits(bits);
}

/// Tells the processor to fetch what is there into its cache, for reading. Where compilers have no
/// word for that, nothing happens.
inline void prefetch([[maybe_unused]] const void* memory) noexcept {
#if defined(__GNUC__)
  __builtin_prefetch(memory);
#endif
}

}  // namespace hexhex
