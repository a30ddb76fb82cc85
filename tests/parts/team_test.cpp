// Processes that each make a part make the same parts as one that makes all; and where one of them
// fails, all do. The processes are threads; tests/mpi has real ones.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include <hexhex/samples.hpp>
#include <hexhex/team.hpp>

#include "support/damaged_maps.hpp"
#include "support/thread_team.hpp"
#if !defined(_WIN32)  // where builds have no HDF5
#include "io/other_programs.hpp"
#endif

namespace hexhex {
namespace {

using test::ThreadTeam;

TEST(Team, MakesThePartsOfOneProcess) {
  std::mt19937_64 random(9);
  for (const std::uint32_t size : {1U, 2U, 3U, 8U}) {
    test::MapDamage draw(random());
    const TetMap map = draw.sample();
    PartOptions options;
    options.parts = size;
    options.ghostLayers = draw.below(2U);
    Context context;
    ExtractStatistics whole;
    const std::vector<MeshPart> expected = extractParts(map, {}, options, context, &whole);
    std::vector<MeshPart> parts(size);
    std::vector<ExtractStatistics> statistics(size);
    const auto errors = ThreadTeam(size).run([&](ProcessTeam& team) {
      // Only the first process has the map.
      const TetMap shared = shareMap(team, team.rank() == 0 ? TetMapView(map) : TetMapView());
      Context own(1);
      parts[team.rank()] = extractPart(team, team.rank() == 0 ? map : shared, {},
                                       {1, options.ghostLayers}, own, &statistics[team.rank()]);
    });
    for (std::uint32_t r = 0; r < size; ++r) {
      EXPECT_FALSE(errors[r]) << errors[r]->what();
      EXPECT_TRUE(test::isSamePart(parts[r], expected[r])) << r << " of " << size;
      EXPECT_EQ(statistics[r].vertices, whole.vertices);
      EXPECT_EQ(statistics[r].generators, whole.generators);
    }
  }
}

TEST(Team, MayHaveMoreProcessesThanTetsAndCells) {
  SampleOptions options;
  options.cells = 1;
  const TetMap map = generateSample(SampleKind::Box, options).map;
  std::vector<std::uint64_t> cells(20);
  const auto errors = ThreadTeam(20).run([&](ProcessTeam& team) {
    Context context(1);
    PartsSummary summary;
    class Count final : public PartSink {
     public:
      explicit Count(std::uint64_t& cells) : cells_(cells) {}
      void begin(const PartsInfo& /*info*/) override {}
      void part(MeshPart&& part) override { cells_ = part.ownCells; }
      void end() override {}

     private:
      std::uint64_t& cells_;
    } count(cells[team.rank()]);
    extractPart(team, count, map, {}, {}, context, nullptr, &summary);
    EXPECT_EQ(summary.cells, 8U);
    EXPECT_EQ(summary.empty, 12U);
    EXPECT_EQ(summary.smallest, 0U);
    EXPECT_EQ(summary.largest, 1U);
  });
  for (const auto& error : errors) EXPECT_FALSE(error);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 1U), 8);
}

/// All of a team must have failed alike.
void expectAll(const std::vector<std::optional<Error>>& errors, ErrorCode code,
               const std::string& text) {
  for (const auto& error : errors) {
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), code);
    EXPECT_NE(std::string(error->what()).find(text), std::string::npos) << error->what();
    EXPECT_STREQ(error->what(), errors[0]->what());
  }
}

TEST(Team, FailsWhereOneProcessDoes) {
  const auto errors = ThreadTeam(4).run([](ProcessTeam& team) {
    static_cast<void>(team.gather({}));
    if (team.rank() == 2)
      throw Error(ErrorCode::FileWrite, "The disk is full.", {PlaceKind::Tet, 7});
    static_cast<void>(team.gather({}));
    ADD_FAILURE() << "nobody gets here";
  });
  expectAll(errors, ErrorCode::FileWrite, "Process 2: The disk is full.");
  EXPECT_EQ(errors[0]->place().index, 7U);
}

TEST(Team, FailsInTheEndToo) {
  const auto errors = ThreadTeam(3).run([](ProcessTeam& team) {
    if (team.rank() > 0) throw std::bad_alloc();
  });
  expectAll(errors, ErrorCode::OutOfMemory, "Process 1: ");
}

TEST(Team, FailsInASinkOfOneProcess) {
  class Full final : public PartSink {
   public:
    explicit Full(std::uint32_t rank) : rank_(rank) {}
    void begin(const PartsInfo& /*info*/) override {}
    void part(MeshPart&& /*part*/) override {
      if (rank_ == 1) throw Error(ErrorCode::FileWrite, "full");
    }
    void end() override { ADD_FAILURE() << "the parts are not all there"; }

   private:
    std::uint32_t rank_;
  };
  const TetMap map = generateSample(SampleKind::Box, {}).map;
  const auto errors = ThreadTeam(3).run([&](ProcessTeam& team) {
    Full sink(team.rank());
    Context context(1);
    extractPart(team, sink, map, {}, {}, context);
  });
  expectAll(errors, ErrorCode::FileWrite, "Process 1: full");
}

TEST(Team, RefusesDifferentMapsAndOptions) {
  const TetMap map = generateSample(SampleKind::Box, {}).map;
  TetMap other = map;
  other.points[0][2] += 1e-9;
  const auto run = [&](const TetMap& second, const ExtractOptions& options,
                       const PartOptions& parts) {
    return ThreadTeam(2).run([&](ProcessTeam& team) {
      Context context(1);
      const bool first = team.rank() == 0;
      static_cast<void>(extractPart(team, first ? map : second, first ? ExtractOptions{} : options,
                                    parts, context));
    });
  };
  ExtractOptions scaled;
  scaled.scale = 2;
  expectAll(run(other, {}, {}), ErrorCode::InvalidArgument, "Processes 0 and 1 have different");
  expectAll(run(map, scaled, {}), ErrorCode::InvalidArgument, "Processes 0 and 1 have different");
  expectAll(run(map, {}, {3}), ErrorCode::InvalidArgument, "There are 3 parts and 2 processes");
  EXPECT_FALSE(run(map, {}, {2})[0]);
}

TEST(Team, SharesTextsAndGathersNumbers) {
  const auto errors = ThreadTeam(3).run([](ProcessTeam& team) {
    EXPECT_EQ(team.shareText(team.rank() == 0 ? "from the first" : "x"), "from the first");
    EXPECT_EQ(team.shareText(""), "");
    const std::vector<std::uint64_t> mine(team.rank(), team.rank());
    const GatheredNumbers all = team.gather(mine);
    EXPECT_EQ(all.numbers, (std::vector<std::uint64_t>{1, 2, 2}));
    EXPECT_EQ(all.of(2).size(), 2U);
  });
  for (const auto& error : errors) EXPECT_FALSE(error);
}

namespace fs = std::filesystem;

class TeamFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("hexhex-team-" + std::to_string(std::random_device()()));
    fs::create_directories(folder_);
    SampleOptions options;
    options.cells = 3;
    options.features = true;
    map_ = generateSample(SampleKind::Shell, options).map;
  }
  void TearDown() override { fs::remove_all(folder_); }

  static WriteOptions writingOf(const PartFormat& format) {
    WriteOptions writing;
    writing.format = format.name;
    return writing;
  }
  /// What is in a folder, by name.
  static std::map<std::string, std::string> contentsOf(const fs::path& folder) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      std::ostringstream text;
      text << stream.rdbuf();
      contents[entry.path().lexically_relative(folder).string()] = text.str();
    }
    return contents;
  }

  /// Whether two folders have the same files. Those of HDF5 have the same contents, not the same
  /// bytes.
  static void expectSame(const fs::path& one, const fs::path& many, const std::string& what) {
    auto expected = contentsOf(one);
    auto found = contentsOf(many);
#if !defined(_WIN32)
    if (expected.erase("x.vtkhdf") + found.erase("x.vtkhdf") == 2) {
      const fs::path script = fs::path(__FILE__).parent_path() / "same_vtkhdf.py";
      const int code = test::runCommand(test::interpreter() + " '" + script.string() + "' '" +
                                        (one / "x.vtkhdf").string() + "' '" +
                                        (many / "x.vtkhdf").string() + "'");
      EXPECT_TRUE(code == 0 || test::isMissing(code)) << what;
    }
#endif
    EXPECT_EQ(expected, found) << what;
  }
  /// Formats that teams write, in this build.
  [[nodiscard]] std::vector<PartFormat> formatsOfTeams() const {
    std::vector<PartFormat> formats;
    Context context;
    for (const PartFormat& format : partFormats()) {
      if (!format.byTeams) continue;
      try {
        static_cast<void>(openPartSink(folder_ / "x", writingOf(format), context));
        formats.push_back(format);
      } catch (const Error& error) {
        EXPECT_EQ(format.name, "vtkhdf") << error.what();  // a build without HDF5
      }
    }
    return formats;
  }

  fs::path folder_;
  TetMap map_;
};

TEST_F(TeamFiles, HaveOneNameAndFormat) {
  const auto open = [&](const fs::path& file, const WriteOptions& other) {
    return ThreadTeam(3).run([&](ProcessTeam& team) {
      Context context(1);
      const bool last = team.rank() == 2;
      const auto sink = openPartSink(last ? file : folder_ / "x.pvtu",
                                     last ? other : WriteOptions{}, context, &team);
      extractPart(team, *sink, map_, {}, {}, context);
    });
  };
  expectAll(open(folder_ / "y.pvtu", {}), ErrorCode::InvalidArgument, "y.pvtu");
  expectAll(open(folder_ / "x.msh", {}), ErrorCode::InvalidArgument, "x.msh");
  expectAll(open(folder_ / "x.pvtu", {.format = "pvtu"}), ErrorCode::InvalidArgument, "pvtu");
  expectAll(open(folder_ / "x.pvtu", {.patchAngle = 30}), ErrorCode::InvalidArgument, "30");
  EXPECT_TRUE(contentsOf(folder_).empty());
  EXPECT_FALSE(open(folder_ / "x.pvtu", {})[0]);
  EXPECT_FALSE(contentsOf(folder_).empty());
}

TEST_F(TeamFiles, AreThoseOfOneProcess) {
  for (const PartFormat& format : formatsOfTeams()) {
    for (const std::uint32_t size : {1U, 4U, 9U}) {
      const fs::path one = folder_ / "one" / ("x" + std::string(format.extension));
      const fs::path many = folder_ / "many" / one.filename();
      fs::create_directories(one.parent_path());
      fs::create_directories(many.parent_path());
      Context context;
      const auto sink = openPartSink(one, writingOf(format), context);
      extractParts(*sink, map_, {}, {size}, context);
      const auto errors = ThreadTeam(size).run([&](ProcessTeam& team) {
        Context own(1);
        const auto part = openPartSink(many, writingOf(format), own, &team);
        extractPart(team, *part, map_, {}, {}, own);
      });
      EXPECT_FALSE(errors[0]) << errors[0]->what();
      expectSame(folder_ / "one", folder_ / "many",
                 std::string(format.name) + ", " + std::to_string(size));
      fs::remove_all(folder_ / "one");
      fs::remove_all(folder_ / "many");
    }
  }
}

/// Hands on to files, and fails in one process at the end of its part.
class Failing final : public PartSink {
 public:
  Failing(PartSink& sink, bool fails) : sink_(sink), fails_(fails) {}
  void begin(const PartsInfo& info) override { sink_.begin(info); }
  void part(MeshPart&& part) override {
    sink_.part(std::move(part));
    if (fails_) throw Error(ErrorCode::FileWrite, "full");
  }
  void end() override { sink_.end(); }
  [[nodiscard]] std::uint32_t neededGhostLayers() const override {
    return sink_.neededGhostLayers();
  }

 private:
  PartSink& sink_;
  bool fails_;
};

TEST_F(TeamFiles, DoNotAppearWhereOneProcessFails) {
  for (const PartFormat& format : formatsOfTeams()) {
    const fs::path file = folder_ / ("x" + std::string(format.extension));
    const auto errors = ThreadTeam(3).run([&](ProcessTeam& team) {
      Context context(1);
      const auto files = openPartSink(file, writingOf(format), context, &team);
      Failing sink(*files, team.rank() == 1);
      extractPart(team, sink, map_, {}, {}, context);
    });
    expectAll(errors, ErrorCode::FileWrite, "Process 1: full");
    EXPECT_TRUE(fs::is_empty(folder_)) << format.name;
  }
}

TEST_F(TeamFiles, ThatCannotBeNamedTakeTheOthersBack) {
  WriteOptions writing;
  writing.format = "msh-split";
  const auto errors = ThreadTeam(3).run([&](ProcessTeam& team) {
    Context context(1);
    const auto files = openPartSink(folder_ / "x.msh", writing, context, &team);
    // Once its file is open, there is a folder where it shall be.
    class Blocking final : public PartSink {
     public:
      Blocking(PartSink& sink, fs::path place) : sink_(sink), place_(std::move(place)) {}
      void begin(const PartsInfo& info) override { sink_.begin(info); }
      void part(MeshPart&& part) override {
        sink_.part(std::move(part));
        if (!place_.empty()) fs::create_directories(place_ / "full");
      }
      void end() override { sink_.end(); }

     private:
      PartSink& sink_;
      fs::path place_;
    } sink(*files, team.rank() == 2 ? folder_ / "x_3.msh" : fs::path());
    extractPart(team, sink, map_, {}, {}, context);
  });
  expectAll(errors, ErrorCode::FileWrite, "Process 2: ");
  EXPECT_FALSE(fs::exists(folder_ / "x_1.msh"));
  EXPECT_FALSE(fs::exists(folder_ / "x_2.msh"));
}

TEST_F(TeamFiles, OfOtherFormatsAreRefused) {
  const auto errors = ThreadTeam(2).run([&](ProcessTeam& team) {
    Context context(1);
    static_cast<void>(openPartSink(folder_ / "x.cgns", {}, context, &team));
  });
  expectAll(errors, ErrorCode::FileUnsupported, "several processes cannot write");
  EXPECT_THROW(requirePartFormat("x.cgns", {}, true), Error);
}

}  // namespace
}  // namespace hexhex
