// Of RapidCheck as much as the tests use, for compilers that Debian has no library of it for: draws
// the same cases each time, and does not make failing ones smaller.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace rc {

inline std::mt19937_64& source() {
  static std::mt19937_64 numbers;
  return numbers;
}

template <class T>
struct Gen {
  std::function<T()> draw;
  T operator*() const { return draw(); }
};

namespace gen {

/// @param end  not included
template <class T>
Gen<T> inRange(T begin, T end) {
  return {[begin, end] {
    const auto size = static_cast<std::uint64_t>(end) - static_cast<std::uint64_t>(begin);
    return static_cast<T>(static_cast<std::uint64_t>(begin) + source()() % size);
  }};
}
template <class T>
Gen<T> arbitrary() {
  static_assert(std::is_integral_v<T>);
  // Small numbers as well as large ones.
  return {[] { return static_cast<T>(source()() >> source()() % 64); }};
}
template <class Container>
auto elementOf(const Container& list) {
  using T = typename Container::value_type;
  return Gen<T>{
      [kept = std::vector<T>(list.begin(), list.end())] { return kept[source()() % kept.size()]; }};
}
template <class T, class... More>
Gen<T> element(T first, More... more) {
  return elementOf(std::vector<T>{first, static_cast<T>(more)...});
}

}  // namespace gen

/// How many cases: as RC_PARAMS says.
inline int cases() {
  constexpr const char* kName = "max_success=";
  const char* const parameters = std::getenv("RC_PARAMS");
  const char* const found = parameters == nullptr ? nullptr : std::strstr(parameters, kName);
  return found == nullptr ? 100 : std::atoi(found + std::strlen(kName));
}

/// @return whether the property held for all cases; what did not is printed
template <class Property>
bool check(const std::string& name, const Property& property) {
  source().seed(1);
  for (int i = 0; i < cases(); ++i) {
    try {
      property();
    } catch (const std::exception& failure) {
      std::cerr << name << ": case " << i << ": " << failure.what() << '\n';
      return false;
    }
  }
  return true;
}
template <class Property>
bool check(const Property& property) {
  return check("property", property);
}

}  // namespace rc

#define RC_ASSERT(condition) \
  if (!(condition)) throw std::runtime_error("this does not hold: " #condition)
