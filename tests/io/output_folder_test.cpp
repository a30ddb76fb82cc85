// Folders appear complete or not at all, and what was in them before stays.
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

void fill(const OutputFolder& folder, const std::string& text) {
  OutputFile file(folder.temporary() / "points");
  file.write(text).commit();
}

TEST(OutputFolder, AppearsOnCommitOnly) {
  const TemporaryFolder here;
  {
    OutputFolder folder(here / "constant/polyMesh");
    fill(folder, "new");
    EXPECT_FALSE(std::filesystem::exists(here / "constant/polyMesh"));
    folder.commit();
  }
  EXPECT_EQ(contentOf(here / "constant/polyMesh/points"), "new");
  EXPECT_EQ(here.fileCount(), 1U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(here / "constant"), {}), 1);
}

TEST(OutputFolder, WithoutCommitNothingIsLeft) {
  const TemporaryFolder here;
  { fill(OutputFolder(here / "case/constant/polyMesh"), "new"); }
  EXPECT_TRUE(std::filesystem::is_empty(here.path()));
}

TEST(OutputFolder, KeepsWhatElseIsThere) {
  const TemporaryFolder here;
  const auto mesh = here / "polyMesh";
  std::filesystem::create_directories(mesh / "sets/deep");
  std::ofstream(mesh / "points") << "old";
  std::ofstream(mesh / "mine") << "mine";
  std::ofstream(mesh / "sets/deep/set") << "set";
  std::filesystem::create_symlink("/nowhere", mesh / "link");
  const auto expectMine = [&] {
    EXPECT_EQ(contentOf(mesh / "mine"), "mine");
    EXPECT_EQ(contentOf(mesh / "sets/deep/set"), "set");
    EXPECT_EQ(std::filesystem::read_symlink(mesh / "link"), "/nowhere");
    EXPECT_EQ(here.fileCount(), 1U);
  };
  {
    OutputFolder folder(mesh);
    fill(folder, "new");
    folder.commit();
  }
  EXPECT_EQ(contentOf(mesh / "points"), "new");
  expectMine();
  {
    OutputFolder folder(mesh);
    fill(folder, "newer");
    folder.commit();
    EXPECT_EQ(contentOf(mesh / "points"), "newer");
    folder.takeBack();
  }
  EXPECT_EQ(contentOf(mesh / "points"), "new");
  expectMine();
}

TEST(OutputFolder, TakesBackWhatWasNotThere) {
  const TemporaryFolder here;
  {
    OutputFolder folder(here / "constant/polyMesh");
    fill(folder, "new");
    folder.commit();
    folder.takeBack();
  }
  EXPECT_TRUE(std::filesystem::is_empty(here.path()));
}

TEST(OutputFolder, FollowsLinks) {
  const TemporaryFolder here;
  std::filesystem::create_directory(here / "real");
  std::filesystem::create_directory_symlink(here / "real", here / "polyMesh");
  {
    OutputFolder folder(here / "polyMesh");
    fill(folder, "new");
    folder.commit();
  }
  EXPECT_TRUE(std::filesystem::is_symlink(here / "polyMesh"));
  EXPECT_EQ(contentOf(here / "real/points"), "new");
  std::filesystem::create_symlink("loop", here / "loop");
  EXPECT_EQ(failureOf([&] { OutputFolder folder(here / "loop"); }).code, ErrorCode::FileWrite);
}

TEST(OutputFolder, SaysWhereItCannotBe) {
  const TemporaryFolder here;
  std::ofstream(here / "file") << "x";
  for (const auto& target : {here / "file", here / "file/constant/polyMesh"}) {
    const Failure failure = failureOf([&] { OutputFolder folder(target); });
    EXPECT_EQ(failure.code, ErrorCode::FileWrite);
    EXPECT_NE(failure.sentence.find(target.string()), std::string::npos) << failure.sentence;
  }
  EXPECT_EQ(here.fileCount(), 1U);
}

}  // namespace
}  // namespace hexhex::test
