// Changes of files that keep their structure: blocks of binary formats with what tells their sizes
// and places, lines and numbers of texts.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace hexhex::fuzz {

/// SplitMix64.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  /// Uniform enough in [0, count).
  std::size_t below(std::size_t count) {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<std::size_t>((z ^ (z >> 31U)) % count);
  }

 private:
  std::uint64_t state_;
};

/// Changes bytes anyhow: libFuzzer's own mutation.
using ChangeBytes = std::function<std::string(const std::string& bytes)>;

/// Each returns the file as it was if it has not the structure.
std::string changeOvmb(const std::string& file, Dice& dice, const ChangeBytes& change);
std::string changeMeshb(const std::string& file, Dice& dice, const ChangeBytes& change);
/// Arrays that are appended as raw bytes, whose offsets the tags tell.
std::string changeAppended(const std::string& file, Dice& dice, const ChangeBytes& change);
/// A line is lost, doubled or moved, or a number becomes another one.
std::string changeText(const std::string& file, Dice& dice);

}  // namespace hexhex::fuzz
