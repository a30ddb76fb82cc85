// Included before every file of a mutated tree: operators and constants that become others when
// their mutant is switched on, so that one build holds all mutants.
//
//     HEXHEX_MUTANT=7               switches mutant 7 on; they are numbered from 1 on
//     HEXHEX_MUTANTS_REACHED=FILE   appends the numbers of all mutants that were executed to the
//     file
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <utility>

namespace hexhex_mutation {

inline constexpr std::size_t kMostMutants = 100000;
inline constinit volatile bool reached[kMostMutants] = {};

/// 0: none, also before it is known.
inline const int active = [] {
  const char* number = std::getenv("HEXHEX_MUTANT");
  return number == nullptr ? 0 : std::atoi(number);
}();

/// Writes what was reached when the program ends.
struct Recorder {
  ~Recorder() {
    const char* name = std::getenv("HEXHEX_MUTANTS_REACHED");
    std::FILE* const file = name == nullptr ? nullptr : std::fopen(name, "a");
    if (file == nullptr) return;
    for (std::size_t i = 0; i < kMostMutants; ++i) {
      if (reached[i]) std::fprintf(file, "%zu\n", i);
    }
    std::fclose(file);
  }
};
inline const Recorder recorder;

/// Constants that the compiler computes are never changed.
constexpr bool on(int mutant) {
  if (std::is_constant_evaluated()) return false;
  if (!reached[mutant]) reached[mutant] = true;
  return mutant == active;
}

template <class Number>
constexpr Number constant(int mutant, Number right) {
  return on(mutant) ? static_cast<Number>(right + 1) : right;
}

// `a < Less{7} < b` is `a < b`, or with mutant 7 `a <= b`: the operators keep their precedence.
#define HEXHEX_MUTATED(Name, Right, Wrong)                                    \
  struct Name {                                                               \
    int mutant;                                                               \
  };                                                                          \
  template <class Left>                                                       \
  struct Name##Left {                                                         \
    Left&& left;                                                              \
    int mutant;                                                               \
  };                                                                          \
  template <class Left>                                                       \
  constexpr Name##Left<Left> operator Right(Left&& left, Name mutated) {      \
    return {std::forward<Left>(left), mutated.mutant};                        \
  }                                                                           \
  template <class Left, class Operand>                                        \
  constexpr auto operator Right(Name##Left<Left> left, Operand&& operand) {   \
    using Result = std::remove_cvref_t<decltype(left.left Right operand)>;    \
    if (on(left.mutant)) return static_cast<Result>(left.left Wrong operand); \
    return static_cast<Result>(left.left Right operand);                      \
  }

HEXHEX_MUTATED(Less, <, <=)
HEXHEX_MUTATED(LessEqual, <=, <)
HEXHEX_MUTATED(Greater, >, >=)
HEXHEX_MUTATED(GreaterEqual, >=, >)
HEXHEX_MUTATED(Equal, ==, !=)
HEXHEX_MUTATED(Unequal, !=, ==)
HEXHEX_MUTATED(Plus, +, -)
HEXHEX_MUTATED(Minus, -, +)
HEXHEX_MUTATED(Times, *, +)
HEXHEX_MUTATED(Quotient, /, *)
HEXHEX_MUTATED(Remainder, %, +)
HEXHEX_MUTATED(ShiftLeft, <<, >>)
HEXHEX_MUTATED(ShiftRight, >>, <<)
HEXHEX_MUTATED(And, &, |)
HEXHEX_MUTATED(Or, |, &)
HEXHEX_MUTATED(ExclusiveOr, ^, |)

#undef HEXHEX_MUTATED

}  // namespace hexhex_mutation
