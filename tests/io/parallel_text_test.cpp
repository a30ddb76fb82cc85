// Text that several threads read and write: the same result and the same error as with one.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <base/stage.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

/// A text of words and gaps, long enough for many blocks of an index.
std::string randomText(Random& random, std::size_t size) {
  std::string text;
  while (text.size() < size) {
    text += std::string(random.below(4) == 0 ? random.below(9000) : random.below(5), 'x');
    text += std::string(random.below(6) == 0 ? random.below(9000) : random.below(3),
                        " \t\n\v\f\r"[random.below(6)]);
  }
  text.resize(size);
  return text;
}

/// Positions of the beginnings of all tokens, found in the simplest way.
std::vector<std::size_t> tokenBegins(const std::string& text) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!isSpace(text[i]) && (i == 0 || isSpace(text[i - 1]))) begins.push_back(i);
  }
  return begins;
}

TEST(TokenIndex, FindsEveryToken) {
  Random random(3);
  Context context;
  Stage stage(context, "test");
  for (const std::size_t size : {0U, 1U, 2U, 8191U, 8192U, 8193U, 16384U, 100'000U, 700'000U}) {
    const std::string text = randomText(random, size);
    const TokenIndex index(text, stage);
    const std::vector<std::size_t> begins = tokenBegins(text);
    ASSERT_EQ(index.count(), begins.size()) << size;
    for (std::size_t i = 0; i < begins.size(); i += 1 + random.below(5)) {
      ASSERT_EQ(index.find(i), begins[i]) << i << " of " << size;
      ASSERT_EQ(index.countBefore(begins[i]), i);
      ASSERT_EQ(index.countBefore(begins[i] + 1), i + 1);
    }
    EXPECT_EQ(index.find(begins.size()), text.size());
    EXPECT_EQ(index.countBefore(text.size()), begins.size());
  }
}

/// Several thousand tets on one line or on many, with whatever white space.
std::string hexexText(std::size_t tets, char separator) {
  std::string text = "4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + std::to_string(tets) + "\n";
  for (std::size_t i = 0; i < tets; ++i) {
    text += "0 1 2 3  " + std::to_string(i) + ".25 1/3 0  1e0 0 0  0 1 0  0 0 1";
    text += separator;
  }
  return text;
}

TetMap parseMap(const std::string& text, const std::string& name, Context& context) {
  return readBytes<readHexex>(text, name, context, ReadOptions{});
}

TEST(ParallelText, LinesMeanNothing) {
  constexpr std::size_t kTets = 5000;
  Context context;
  const TetMap expected = parseMap(hexexText(kTets, '\n'), "m", context);
  ASSERT_EQ(expected.tets.size(), kTets);
  EXPECT_EQ(expected.parameters[kTets - 1][0][0], kTets - 1 + 0.25);
  for (const char separator : {' ', '\t', '\r'}) {
    const TetMap map = parseMap(hexexText(kTets, separator), "m", context);
    EXPECT_EQ(map.parameters, expected.parameters);
  }
}

/// What parsing gives, as text.
template <class Parse>
std::string outcome(const std::string& text, int threads, const Parse& parse) {
  Context context(threads);
  try {
    static_cast<void>(parse(text, "m", context));
    return "good";
  } catch (const Error& error) {
    return std::string(error.what()) + " | " + toString(error.place());
  }
}

template <class Parse>
void expectSameErrors(const std::string& good, const Parse& parse) {
  ASSERT_EQ(outcome(good, 3, parse), "good");
  Random random(11);
  std::size_t refused = 0;
  for (int i = 0; i < 60; ++i) {
    std::string text = good;
    for (std::size_t k = 1 + random.below(5); k > 0; --k) {
      text[random.below(text.size())] = "x -/9\n"[random.below(6)];
    }
    if (random.below(4) == 0) text.resize(random.below(text.size()));
    const std::string alone = outcome(text, 1, parse);
    EXPECT_EQ(outcome(text, 2, parse), alone);
    EXPECT_EQ(outcome(text, 5, parse), alone);
    if (alone != "good") ++refused;
  }
  EXPECT_GT(refused, 20U);
}

TEST(ParallelText, HexexErrorsAreThoseOfOneThread) {
  expectSameErrors(hexexText(6000, '\n'), parseMap);
}

TEST(ParallelText, MeditErrorsAreThoseOfOneThread) {
  const TemporaryFolder folder;
  writeHexMesh(gridMesh(20, 20, 20), folder / "a.mesh");
  expectSameErrors(contentOf(folder / "a.mesh"),
                   [](const std::string& text, const std::string& name, Context& context) {
                     return readBytes<Medit::readMesh>(text, name, context);
                   });
}

TEST(ParallelText, TheFirstOfManyErrorsWithItsLine) {
  std::string text = hexexText(9000, '\n');
  for (std::size_t place = text.find("4321.25"); place != std::string::npos;
       place = text.find(".25", place + 1)) {
    text[place] = 'x';
  }
  for (const int threads : {1, 2, 7}) {
    Context context(threads);
    const Failure failure =
        failureOf([&] { static_cast<void>(parseMap(text, "m.hexex", context)); });
    EXPECT_TRUE(
        failure.sentence.starts_with("m.hexex, line 4328: expected a parameter of tet 4321"))
        << failure.sentence;
  }
}

TEST(ParallelText, CommentsDoNotMatter) {
  const TemporaryFolder folder;
  const HexMesh grid = gridMesh(30, 20, 10);
  writeHexMesh(grid, folder / "a.mesh");
  Context context(3);
  const std::string text = contentOf(folder / "a.mesh");
  const HexMesh plain = readBytes<Medit::readMesh>(text, "m", context);
  const HexMesh commented = readBytes<Medit::readMesh>("# 1 2 3\n" + text, "m", context);
  expectSameBits(grid.points, plain.points);
  expectSameBits(grid.points, commented.points);
  EXPECT_EQ(grid.cells, plain.cells);
  EXPECT_EQ(grid.cells, commented.cells);
}

TEST(ParallelText, FilesAreTheSameWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const HexMesh grid = gridMesh(40, 30, 20);
  TetMap map;
  Random random(2);
  for (Index i = 0; i < 20'000; ++i) {
    map.points.push_back({random.anyDouble(), random.anyDouble(), random.anyDouble()});
    map.tets.push_back({i, i / 2, i / 3, 0});
    map.parameters.push_back(
        {{{random.anyDouble(), 1, 2}, {0, -1, 0.5}, {3, 4, 5}, {i / 7.0, 0, 0}}});
  }
  for (const int threads : {1, 2, 5}) {
    Context context(threads);
    const std::string name = std::to_string(threads);
    writeHexMesh(grid, folder / (name + ".mesh"), context);
    writeHexMesh(grid, folder / (name + ".vtu"), context);
    writeMap(map, folder / (name + ".hexex"), context);
    for (const char* extension : {".mesh", ".vtu", ".hexex"}) {
      EXPECT_TRUE(contentOf((folder / "1").replace_extension(extension)) ==
                  contentOf((folder / name).replace_extension(extension)));
    }
    const TetMap read = readMap(folder / (name + ".hexex"), context);
    EXPECT_EQ(read.tets, map.tets);
    expectSameBits(read.points, map.points);
  }
}

}  // namespace
}  // namespace hexhex::test
