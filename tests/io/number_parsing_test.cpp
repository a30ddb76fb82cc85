// Numbers in files: decimals of any length and rationals, both rounded to the nearest double.
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <io/core/text_scanner.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

double parsed(const std::string& token) {
  double value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(parseNumber(token, value), NumberProblem::None) << token;
  return value;
}

NumberProblem problemOf(const std::string& token) {
  double value = 0;
  return parseNumber(token, value);
}

cpp_rational exactly(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  cpp_rational value{cpp_int(static_cast<std::int64_t>(std::ldexp(mantissa, 53)))};
  const cpp_int power = cpp_int(1) << static_cast<unsigned>(std::abs(exponent - 53));
  return exponent >= 53 ? cpp_rational(value * power) : cpp_rational(value / power);
}

bool isEven(double x) { return std::bit_cast<std::uint64_t>(x) % 2 == 0; }

/// Whether no other double is nearer to `value`, and ties went to the even one. x >= 0, finite.
::testing::AssertionResult isNearest(const cpp_rational& value, double x) {
  const cpp_rational error = abs(cpp_rational(value - exactly(x)));
  const double above = std::nextafter(x, std::numeric_limits<double>::infinity());
  for (const double other : {std::nextafter(x, -1.0), above}) {
    if (std::isinf(other)) continue;
    const cpp_rational otherError = abs(cpp_rational(value - exactly(other)));
    if (otherError < error || (otherError == error && !isEven(x))) {
      return ::testing::AssertionFailure() << x << " instead of " << other;
    }
  }
  return ::testing::AssertionSuccess();
}

std::string randomDigits(Random& random, std::size_t length) {
  std::string digits(1, static_cast<char>('1' + random.below(9)));
  while (digits.size() < length) digits += static_cast<char>('0' + random.below(10));
  return digits;
}

TEST(NumberParsing, ExactExpansionsOfHundredsOfDigits) {
  Random random(1);
  std::vector<char> buffer(2000);
  for (int i = 0; i < 2000; ++i) {
    const double value = random.anyDouble();
    // glibc prints all digits: 1074 after the point are enough for any double.
    const int size = std::snprintf(buffer.data(), buffer.size(), "%.1074f", value);
    const std::string text(buffer.data(), static_cast<std::size_t>(size));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(parsed(text)), std::bit_cast<std::uint64_t>(value));
  }
}

TEST(NumberParsing, TiesGoToEvenHoweverFarAwayTheDecidingDigitIs) {
  // 2^53 + 1 lies in the middle between two doubles.
  EXPECT_EQ(parsed("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(parsed("9007199254740993." + std::string(500, '0') + "1"), 9007199254740994.0);
  EXPECT_EQ(parsed("9007199254740993" + std::string(40, '0') + "/1" + std::string(40, '0')),
            9007199254740992.0);
  EXPECT_EQ(parsed("9007199254740993" + std::string(39, '0') + "1/1" + std::string(40, '0')),
            9007199254740994.0);
  EXPECT_EQ(parsed("9007199254740995/1"), 9007199254740996.0);
}

TEST(NumberParsing, RationalsAgreeWithExactArithmetic) {
  Random random(2);
  for (int i = 0; i < 3000; ++i) {
    const std::string p = randomDigits(random, 1 + random.below(i % 10 == 0 ? 400 : 40));
    const std::string q = randomDigits(random, 1 + random.below(i % 10 == 0 ? 400 : 40));
    const double value = nearestQuotient(p, q);
    if (std::isinf(value)) {
      EXPECT_GT(p.size(), q.size() + 300);
      continue;
    }
    EXPECT_TRUE(isNearest(cpp_rational(cpp_int(p), cpp_int(q)), value)) << p << "/" << q;
  }
}

TEST(NumberParsing, RationalsThatAreDoublesOrHalfwayBetweenThem) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double below = std::abs(random.anyDouble());
    const double above = std::nextafter(below, std::numeric_limits<double>::infinity());
    if (std::isinf(above)) continue;
    const cpp_rational low = exactly(below);
    EXPECT_EQ(nearestQuotient(numerator(low).str(), denominator(low).str()), below);
    const cpp_rational middle = (low + exactly(above)) / 2;
    EXPECT_EQ(nearestQuotient(numerator(middle).str(), denominator(middle).str()),
              isEven(below) ? below : above);
  }
}

TEST(NumberParsing, RationalsAtTheEndsOfTheRange) {
  const std::string tiny = "1" + std::string(400, '0');
  EXPECT_EQ(parsed("1/" + tiny), 0.0);
  EXPECT_EQ(problemOf(tiny + "/1"), NumberProblem::Overflow);
  EXPECT_EQ(parsed(tiny + "/" + tiny), 1.0);
  // Half the smallest double is a tie with 0, which is even; anything more rounds up.
  const std::string half = (cpp_int(1) << 1075).str();
  EXPECT_EQ(parsed("1/" + half), 0.0);
  EXPECT_EQ(parsed("1001/" + (cpp_int(1000) << 1075).str()), 5e-324);
  EXPECT_EQ(parsed("3/" + half), 1e-323);
  const std::string largest = cpp_int((cpp_int(1) << 1024) - (cpp_int(1) << 971)).str();
  EXPECT_EQ(parsed(largest + "/1"), std::numeric_limits<double>::max());
  const std::string beyond = cpp_int((cpp_int(1) << 1024) - (cpp_int(1) << 970)).str();
  EXPECT_EQ(problemOf(beyond + "/1"), NumberProblem::Overflow);
}

TEST(NumberParsing, Signs) {
  EXPECT_EQ(parsed("-1/4"), -0.25);
  EXPECT_EQ(parsed("1/-4"), -0.25);
  EXPECT_EQ(parsed("-1/-4"), 0.25);
  EXPECT_EQ(parsed("+1/+4"), 0.25);
  EXPECT_EQ(parsed("0/7"), 0.0);
  EXPECT_EQ(parsed("+.5e1"), 5.0);
  EXPECT_TRUE(std::signbit(parsed("-0")));
}

TEST(NumberParsing, TooSmallIsZeroAndTooLargeAnError) {
  EXPECT_EQ(parsed("1e-400"), 0.0);
  EXPECT_EQ(parsed("0." + std::string(500, '0') + "1"), 0.0);
  EXPECT_EQ(parsed("1e-99999999999999999999"), 0.0);
  EXPECT_EQ(parsed("0e99999999999999999999"), 0.0);
  EXPECT_EQ(parsed("4.9e-324"), 5e-324);
  EXPECT_EQ(parsed("2.2250738585072011e-308"), 2.2250738585072011e-308);  // subnormal
  EXPECT_EQ(parsed("1" + std::string(500, '0') + "e-500"), 1.0);
  for (const char* token :
       {"1e309", "-1e309", "1.7976931348623159e308", "1e99999999999999999999"}) {
    EXPECT_EQ(problemOf(token), NumberProblem::Overflow) << token;
  }
  EXPECT_EQ(problemOf("1" + std::string(309, '0')), NumberProblem::Overflow);
}

TEST(NumberParsing, Refusals) {
  for (const char* token : {"", "+", "-", "+-1", "--1", "1x", "x", "1e", "0x10", "1,5", "1/", "/2",
                            "1/2/3", "1.5/2", "1/2.0", "1 ", "."}) {
    EXPECT_EQ(problemOf(token), NumberProblem::NotANumber) << '"' << token << '"';
  }
  for (const char* token : {"inf", "-inf", "nan", "+Infinity", "NaN"}) {
    EXPECT_EQ(problemOf(token), NumberProblem::NotFinite) << token;
  }
  EXPECT_EQ(problemOf("1/0"), NumberProblem::ZeroDenominator);
  EXPECT_EQ(problemOf("0/-000"), NumberProblem::ZeroDenominator);
  EXPECT_EQ(problemOf("1/" + std::string(kMaxRationalDigits + 1, '1')), NumberProblem::TooLong);
}

}  // namespace
}  // namespace hexhex::test
