// Files appear complete or not at all, whatever goes wrong.
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include <io/core/output_file.hpp>
#include <io/file_size_limit.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace hexhex::io;
namespace {

TEST(OutputFile, AppearsOnCommitOnly) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt");
  file.write("one ").write(2.5).write(' ').write(3U);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  file.commit();
  EXPECT_EQ(contentOf(folder / "a.txt"), "one 2.5 3");
  EXPECT_EQ(folder.fileCount(), 1U);
}

TEST(OutputFile, WithoutCommitNothingIsLeftAndTheOldFileStays) {
  const TemporaryFolder folder;
  writeText(folder / "a.txt", "old");
  { OutputFile(folder / "a.txt").write("new"); }
  EXPECT_EQ(contentOf(folder / "a.txt"), "old");
  EXPECT_EQ(folder.fileCount(), 1U);
}

TEST(OutputFile, BytesAndNumbersBeyondTheBuffer) {
  const TemporaryFolder folder;
  const std::string large(3'000'000, 'x');
  std::string expected;
  {
    OutputFile file(folder / "a.txt");
    for (int i = 0; i < 3; ++i) {
      file.write("head").write(large).write(1e-300);
      expected += "head" + large + "1e-300";
      for (unsigned j = 0; j < 100'000; ++j) {
        file.write(j).write('\n');
        expected += std::to_string(j) + '\n';
      }
    }
    file.commit();
  }
  EXPECT_TRUE(contentOf(folder / "a.txt") == expected);
}

TEST(OutputFile, NamesAsLongAsTheFileSystemAllows) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  OutputFile file(folder / name);
  file.commit();
  EXPECT_TRUE(std::filesystem::exists(folder / name));
}

TEST(OutputFile, LinksKeepPointing) {
  const TemporaryFolder folder;
  writeText(folder / "real", "old");
  std::filesystem::create_symlink(folder / "real", folder / "link");
  OutputFile file(folder / "link");
  file.write("new").commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(contentOf(folder / "real"), "new");
  std::filesystem::create_symlink(folder / "nowhere", folder / "dangling");
  EXPECT_EQ(failureOf([&] { OutputFile dangling(folder / "dangling"); }).code,
            ErrorCode::FileWrite);
}

TEST(OutputFile, DevicesAreWrittenDirectly) {
  OutputFile file("/dev/null");
  file.write("gone").commit();
  EXPECT_FALSE(std::filesystem::is_regular_file("/dev/null"));
}

TEST(OutputFile, FullDeviceIsAnError) {
  const Failure failure = failureOf([] {
    OutputFile file("/dev/full");
    file.write("x").commit();
  });
  EXPECT_EQ(failure.code, ErrorCode::FileWrite);
  EXPECT_NE(failure.sentence.find("/dev/full"), std::string::npos);
  EXPECT_NE(failure.sentence.find("No space left on device"), std::string::npos);
}

TEST(OutputFile, UnusableFolders) {
  const TemporaryFolder folder;
  writeText(folder / "file", "");
  for (const auto& target : {folder / "missing/a.txt", folder / "file/a.txt", folder.path()}) {
    const Failure failure = failureOf([&] { OutputFile file(target); });
    EXPECT_EQ(failure.code, ErrorCode::FileWrite);
    EXPECT_NE(failure.sentence.find(target.string()), std::string::npos) << failure.sentence;
  }
  const std::string advice = "`mkdir -p " + (folder / "missing").string() + "`";
  EXPECT_NE(failureOf([&] { OutputFile file(folder / "missing/a.txt"); }).sentence.find(advice),
            std::string::npos);
  EXPECT_EQ(folder.fileCount(), 1U);
}

TEST(OutputFile, FolderWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write anywhere";
  const TemporaryFolder folder;
  ::chmod(folder.path().c_str(), 0555);
  const Failure failure = failureOf([&] { OutputFile file(folder / "a.txt"); });
  ::chmod(folder.path().c_str(), 0755);
  EXPECT_EQ(failure.code, ErrorCode::FileWrite);
  EXPECT_NE(failure.sentence.find("Permission denied"), std::string::npos);
}

TEST(OutputFile, FullDiskLeavesNothing) {
  const TemporaryFolder folder;
  TetMap map;
  map.points.resize(100'000, Vec3{1.0 / 3, 0.1, 0.7});
  HexMesh mesh = gridMesh(40, 40, 40);
  const FileSizeLimit limit(1'000'000);
  for (const char* name : {"a.hexex", "a.mesh", "a.vtu"}) {
    const Failure failure = failureOf([&] {
      if (std::string(name) == "a.hexex") {
        writeMap(map, folder / name);
      } else {
        writeHexMesh(mesh, folder / name);
      }
    });
    EXPECT_EQ(failure.code, ErrorCode::FileWrite);
    EXPECT_NE(failure.sentence.find("File too large"), std::string::npos) << failure.sentence;
    EXPECT_EQ(folder.fileCount(), 0U);
  }
}

TEST(OutputFile, CancellationLeavesNothing) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(20, 20, 20);
  for (const char* name : {"a.mesh", "a.vtu"}) {
    // Cancelled as soon as writing has begun.
    Context* self = nullptr;
    Context context(1, [&self](std::string_view stage, double share) {
      if (stage == "write mesh" && share > 0) self->cancel();
    });
    self = &context;
    EXPECT_EQ(failureOf([&] { writeHexMesh(mesh, folder / name, context); }).code,
              ErrorCode::Cancelled);
    EXPECT_EQ(folder.fileCount(), 0U);
  }
}

}  // namespace
}  // namespace hexhex::test
