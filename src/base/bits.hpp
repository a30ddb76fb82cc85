// Counts of bits without counting.
#pragma once

namespace hexhex {

[[nodiscard]] constexpr bool hasManyBits(unsigned bits) noexcept {
  return (bits & (bits - 1)) != 0;
}

/// std::has_single_bit is a call where processors may lack an instruction that counts bits.
[[nodiscard]] constexpr bool hasOneBit(unsigned bits) noexcept {
  return bits != 0 && !hasManyBits(bits);
}

}  // namespace hexhex
