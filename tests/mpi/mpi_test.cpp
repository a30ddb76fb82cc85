// The transport of teams, on real processes: `mpirun -n N test_mpi`.
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <unistd.h>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>
#include <hexhex/mpi.hpp>
#include <hexhex/samples.hpp>

#include "support/thread_team.hpp"

namespace hexhex {
namespace {

namespace fs = std::filesystem;

std::uint32_t rankHere() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return static_cast<std::uint32_t>(rank);
}
std::uint32_t sizeHere() {
  int size = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return static_cast<std::uint32_t>(size);
}

TetMap sample() {
  SampleOptions options;
  options.cells = 3;
  options.features = true;
  options.jitter = 0.4;
  return generateSample(SampleKind::Sphere, options).map;
}

MeshPart expectedPart(const TetMap& map, std::uint32_t ghosts) {
  Context context(1);
  return extractParts(map, {}, {sizeHere(), ghosts}, context)[rankHere()];
}

TEST(Mpi, MakesThePartsOfOneProcess) {
  const TetMap map = sample();
  for (const std::uint32_t ghosts : {0U, 1U}) {
    Context context(1);
    const MeshPart part = extractPart(
        MPI_COMM_WORLD, rankHere() == 0 ? TetMapView(map) : TetMapView(), {}, {1, ghosts}, context);
    EXPECT_TRUE(test::isSamePart(part, expectedPart(map, ghosts)));
  }
}

TEST(Mpi, ReadsTheFileOfTheFirst) {
  const fs::path file = fs::path(HEXHEX_DATA_DIR) / "maps" / "s17c_sphere_r1.hexex";
  if (!fs::exists(file)) GTEST_SKIP() << "no real maps";
  Context context(1);
  const MeshPart part =
      extractPart(MPI_COMM_WORLD, rankHere() == 0 ? file : "none.hexex", {}, {}, context);
  EXPECT_TRUE(test::isSamePart(part, expectedPart(readMap(file), 0)));
}

TEST(Mpi, SaysTheSameInAllProcesses) {
  Context context(1);
  try {
    static_cast<void>(extractPart(MPI_COMM_WORLD, "none.hexex", {}, {}, context));
    ADD_FAILURE() << "there is no such file";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::FileNotFound);
  }
  const std::uint32_t last = sizeHere() - 1;
  MpiTeam team(MPI_COMM_WORLD);
  try {
    team.run([&] {
      if (team.rank() == last) throw Error(ErrorCode::FileWrite, "full");
      team.barrier();
      team.barrier();
    });
    ADD_FAILURE() << "one process failed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::FileWrite);
    EXPECT_EQ(std::string(error.what()),
              last == 0 ? "full" : "Process " + std::to_string(last) + ": full");
  }
}

TEST(Mpi, GathersAndSharesMuch) {
  MpiTeam team(MPI_COMM_WORLD);
  team.run([&] {
    const std::size_t count = 100000 * (team.rank() % 3);
    const std::vector<std::uint64_t> mine(count, team.rank());
    const GatheredNumbers all = team.gather(mine);
    for (std::uint32_t r = 0; r < team.size(); ++r) {
      ASSERT_EQ(all.of(r).size(), 100000U * (r % 3));
      for (const std::uint64_t number : all.of(r)) ASSERT_EQ(number, r);
    }
    std::vector<std::uint64_t> shared(300000, 0);
    if (team.rank() == 0) std::iota(shared.begin(), shared.end(), 5);
    team.share(std::as_writable_bytes(std::span(shared)));
    for (std::size_t i = 0; i < shared.size(); ++i) ASSERT_EQ(shared[i], i + 5);
  });
}

}  // namespace
}  // namespace hexhex

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  testing::InitGoogleTest(&argc, argv);
  const int status = RUN_ALL_TESTS();
  MPI_Finalize();
  return status;
}
