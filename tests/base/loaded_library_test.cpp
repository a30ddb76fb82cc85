// Libraries that are loaded at run time.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <base/loaded_library.hpp>

namespace hexhex {
namespace {

// glibc's.
constexpr const char* kMath = "libm.so.6";
constexpr const char* kVariable = "HEXHEX_TEST_LIBRARY";

bool tells(const LoadedLibrary& library, const std::string& what) {
  return library.problem().find(what) != std::string::npos;
}

class LoadedLibraryTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!LoadedLibrary({kMath}).problem().empty()) GTEST_SKIP() << "no " << kMath;
    ::unsetenv(kVariable);
  }
  void TearDown() override { ::unsetenv(kVariable); }
};

TEST_F(LoadedLibraryTest, TakesTheFirstFileThatIsThere) {
  LoadedLibrary library({"libnosuch.so.1", kMath, "libnosuch.so.2"});
  EXPECT_FALSE(library.isMissing());
  EXPECT_EQ(library.problem(), "");
  const auto root = library.find<double (*)(double)>("sqrt");
  ASSERT_NE(root, nullptr);
  EXPECT_EQ(root(9), 3);
}

TEST_F(LoadedLibraryTest, NamesEachFileThatIsMissing) {
  LoadedLibrary library({"libnosuch.so.1", "libnosuch.so.2"});
  EXPECT_TRUE(library.isMissing());
  EXPECT_EQ(library.find<void*>("sqrt"), nullptr);
  EXPECT_TRUE(tells(library, "libnosuch.so.1: ") && tells(library, "; libnosuch.so.2: "))
      << library.problem();
}

TEST_F(LoadedLibraryTest, NamesAMissingSymbol) {
  LoadedLibrary library({kMath});
  EXPECT_EQ(library.find<void*>("hexhexNoSuch"), nullptr);
  EXPECT_TRUE(tells(library, kMath) && tells(library, "hexhexNoSuch")) << library.problem();
}

TEST_F(LoadedLibraryTest, TriesNoOtherFileAfterABrokenOne) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "hexhex_broken_library.so";
  std::ofstream(file) << "This is no library.";
  LoadedLibrary library({"libnosuch.so.1", file.string(), kMath});
  std::filesystem::remove(file);
  EXPECT_FALSE(library.isMissing());
  EXPECT_TRUE(tells(library, "libnosuch.so.1") && tells(library, file.string()))
      << library.problem();
  EXPECT_EQ(library.find<void*>("sqrt"), nullptr);
}

TEST_F(LoadedLibraryTest, TakesTheFileThatTheEnvironmentNamesOrNone) {
  ::setenv(kVariable, "libnosuch.so.1", 1);
  const LoadedLibrary none({kMath}, kVariable);
  EXPECT_FALSE(none.isMissing());
  EXPECT_TRUE(tells(none, "libnosuch.so.1")) << none.problem();
  ::setenv(kVariable, kMath, 1);
  EXPECT_EQ(LoadedLibrary({"libnosuch.so.1"}, kVariable).problem(), "");
  ::unsetenv(kVariable);
  EXPECT_EQ(LoadedLibrary({kMath}, kVariable).problem(), "");
}

}  // namespace
}  // namespace hexhex
