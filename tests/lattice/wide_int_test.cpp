// Int192 against integers of any width.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <lattice/wide_int.hpp>

#include "oracle.hpp"
#include "random.hpp"

namespace hexhex::testing {

using namespace lattice;
namespace {

constexpr std::int64_t kMin64 = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kMax64 = std::numeric_limits<std::int64_t>::max();
constexpr Int128 kMax128 = static_cast<Int128>(~UInt128{0} >> 1);
constexpr Int128 kMin128 = -kMax128 - 1;

BigInteger toBigUnsigned(UInt128 a) {
  return (BigInteger(static_cast<std::uint64_t>(a >> 64)) << 64) + static_cast<std::uint64_t>(a);
}

/// The value of an accumulator, read by its public functions: the upper 128 bits by a shift, the
/// lower 64 after the upper ones are subtracted.
BigInteger valueOf(const Int192& a) {
  if (a.sign() < 0) return -valueOf(-a);
  bool exact = true;
  const UInt128 high = a.shiftedRight(64, exact);
  Int192 low = a;
  for (int i = 0; i < 4; ++i) low.addProduct(-static_cast<Int128>(high), std::int64_t{1} << 62);
  return (toBigUnsigned(high) << 64) + toBigUnsigned(low.shiftedRight(0, exact));
}

/// LatticeRandom bits of random length and sign: small values, and carries over every boundary.
Int128 anyInt128(LatticeRandom& random) {
  const UInt128 bits = (static_cast<UInt128>(random.next()) << 64) | random.next();
  const Int128 magnitude = static_cast<Int128>(bits >> (1 + random.below(127)));
  return random.oneIn(2) ? magnitude : -magnitude;
}

std::int64_t anyInt64(LatticeRandom& random) {
  const auto magnitude = static_cast<std::int64_t>(random.next() >> (1 + random.below(63)));
  return random.oneIn(2) ? magnitude : -magnitude;
}

const std::vector<Int128> kExtreme128 = {0,
                                         1,
                                         -1,
                                         kMax64,
                                         kMin64,
                                         static_cast<Int128>(kMax64) + 1,
                                         static_cast<Int128>(1) << 64,
                                         -(static_cast<Int128>(1) << 64),
                                         (static_cast<Int128>(1) << 64) - 1,
                                         kMax128,
                                         kMin128,
                                         kMin128 + 1};
const std::vector<std::int64_t> kExtreme64 = {0, 1, -1, 2, kMax64, kMin64, kMin64 + 1};

void expectValue(const Int192& actual, const BigInteger& expected) {
  ASSERT_EQ(actual.sign(), signum(expected));
  ASSERT_EQ(valueOf(actual), expected);
  ASSERT_EQ((-actual).sign(), -signum(expected));
  // Three roundings, each of relative size 2^-53.
  const BigInteger error = abs(BigInteger(actual.toDouble()) - expected);
  ASSERT_LE(error << 51, abs(expected));
}

TEST(Int192, ProductsOfExtremeValues) {
  for (const Int128 a : kExtreme128) {
    for (const std::int64_t b : kExtreme64) {
      if (a == kMin128 && b == kMin64) continue;
      Int192 product;
      product.addProduct(a, b);
      ASSERT_NO_FATAL_FAILURE(expectValue(product, toBig(a) * b));
    }
  }
}

TEST(Int192, SumsOfExtremeValuesCarry) {
  for (const Int128 a : kExtreme128) {
    for (const Int128 b : kExtreme128) {
      Int192 sum(a);
      sum += Int192(b);
      ASSERT_NO_FATAL_FAILURE(expectValue(sum, toBig(a) + toBig(b)));
    }
  }
}

TEST(Int192, SumsOfRandomProducts) {
  LatticeRandom random(1);
  const int count = cases(200'000);
  for (int i = 0; i < count; ++i) {
    Int192 sum;
    BigInteger expected;
    for (int term = 0; term < 3; ++term) {
      const Int128 a = anyInt128(random) / 4;  // three terms stay below 2^191
      const std::int64_t b = anyInt64(random);
      sum.addProduct(a, b);
      expected += toBig(a) * b;
    }
    ASSERT_NO_FATAL_FAILURE(expectValue(sum, expected));
  }
}

TEST(Int192, CancelsToZero) {
  LatticeRandom random(2);
  for (int i = 0; i < cases(10'000); ++i) {
    const Int128 a = anyInt128(random);
    const std::int64_t b = anyInt64(random);
    Int192 sum;
    sum.addProduct(a, b);
    sum.addProduct(-a, b);
    ASSERT_EQ(sum.sign(), 0);
    sum.addProduct(a, b);
    sum.addProduct(a, -b);
    ASSERT_EQ(sum.sign(), 0);
    sum += Int192(-1);
    ASSERT_EQ(sum.sign(), -1);
    sum += Int192(2);
    ASSERT_EQ(sum.sign(), 1);
  }
}

TEST(Int192, ShiftedRightTellsTheRemainder) {
  LatticeRandom random(3);
  for (int i = 0; i < cases(2'000); ++i) {
    Int192 value;
    const Int128 a = anyInt128(random);
    const std::int64_t b = std::int64_t{1} << random.below(62);
    value.addProduct(a < 0 ? -a : a, b);
    const BigInteger expected = valueOf(value);
    for (int shift = 0; shift <= 191; ++shift) {
      const BigInteger quotient = expected >> shift;
      if ((quotient >> 128) != 0) continue;
      bool exact = true;
      ASSERT_EQ(toBigUnsigned(value.shiftedRight(shift, exact)), quotient) << "shift " << shift;
      ASSERT_EQ(exact, (quotient << shift) == expected) << "shift " << shift;
      exact = false;
      static_cast<void>(value.shiftedRight(shift, exact));
      ASSERT_FALSE(exact) << "an earlier remainder must not be forgotten";
    }
  }
}

}  // namespace
}  // namespace hexhex::testing
