// Work in a process of its own, and solvers, which need one.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>
#include <quantize/integers/child_process.hpp>
#include <quantize/integers/integer_program.hpp>

#include <hexhex/error.hpp>

#include "lattice/random.hpp"
#include "support/error_of.hpp"

namespace hexhex::test::child_process {

using namespace quantization;
namespace {

using Numbers = std::span<std::int64_t>;

/// Ctrl-C cancels this, as in the command.
Context* interrupted = nullptr;

/// No child is left behind, not even a dead one.
class ChildProcess : public ::testing::Test {
 protected:
  void TearDown() override {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }

  [[nodiscard]] ErrorCode codeOfWork(const std::function<bool(Numbers)>& work) {
    return codeOf([&] { static_cast<void>(inChildProcess(3, context_, work)); });
  }

  Context context_;
};

TEST_F(ChildProcess, MakesNumbers) {
  std::int64_t here = 1;
  const auto numbers = inChildProcess(3, context_, [&](Numbers result) {
    here = 2;
    std::fill(result.begin(), result.end(), here);
    return true;
  });
  EXPECT_EQ(numbers, std::vector<std::int64_t>(3, 2));
  EXPECT_EQ(here, 1);
  EXPECT_EQ(inChildProcess(0, context_, [](Numbers) { return true; })->size(), 0U);
  EXPECT_FALSE(inChildProcess(3, context_, [](Numbers) { return false; }));
}

TEST_F(ChildProcess, MayCrash) {
  EXPECT_EQ(codeOfWork([](Numbers) -> bool { std::abort(); }), ErrorCode::OutOfMemory);
  EXPECT_EQ(codeOfWork([](Numbers) -> bool { _exit(0); }), ErrorCode::OutOfMemory);
  EXPECT_EQ(codeOfWork([](Numbers) -> bool { throw 1; }), ErrorCode::OutOfMemory);
  EXPECT_EQ(codeOfWork([](Numbers) { return kill(getpid(), SIGKILL) == 0; }),
            ErrorCode::OutOfMemory);
  EXPECT_THROW(static_cast<void>(
                   inChildProcess(1, context_, [](Numbers) -> bool { throw std::bad_alloc(); })),
               std::bad_alloc);
}

TEST_F(ChildProcess, PrintsNothing) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  std::printf("before\n");
  static_cast<void>(inChildProcess(1, context_, [](Numbers) {
    std::printf("lost\n");
    std::fprintf(stderr, "lost\n");
    return std::fflush(stdout) == 0;
  }));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "before\n");
}

/// Terminals send signals to parent and child.
TEST_F(ChildProcess, IsReachedByNoSignal) {
  const auto before = std::signal(SIGTERM, [](int) { std::abort(); });
  EXPECT_TRUE(inChildProcess(1, context_, [](Numbers) {
    return raise(SIGINT) == 0 && raise(SIGTERM) == 0 && raise(SIGHUP) == 0;
  }));
  std::signal(SIGTERM, before);
}

TEST_F(ChildProcess, EndsWhenCancelled) {
  context_.cancel();
  EXPECT_EQ(codeOfWork([](Numbers) -> bool {
              for (;;) pause();
            }),
            ErrorCode::Cancelled);
}

TEST_F(ChildProcess, MayEndUnseen) {
  // The system, or a handler, has then waited for it.
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_TRUE(inChildProcess(1, context_, [](Numbers) { return true; }));
  std::signal(SIGCHLD, before);
}

/// Few equations with large factors (market splits, Cornuejols and Dawande 1998): small, but long.
IntegerProgram hardProgram() {
  IntegerProgram program;
  program.lengths.assign(40, 1.5);
  program.least.assign(40, 1);
  testing::LatticeRandom random(24);
  for (int row = 0; row < 4; ++row) {
    ArcEquation equation;
    for (Index arc = 0; arc < 40; ++arc) {
      equation.emplace_back(arc, static_cast<int>(random.between(-50, 50)));
    }
    program.equations.push_back(equation);
  }
  return program;
}

TEST_F(ChildProcess, SolversEndByInterruption) {
  for (const IntegerSolver& solver : {cbcSolver(), highsSolver()}) {
    if (solver.name == nullptr) continue;
    SCOPED_TRACE(solver.name);
    Context context;
    interrupted = &context;
    const auto before = std::signal(SIGINT, [](int) { interrupted->cancel(); });
    std::thread user([] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      kill(getpid(), SIGINT);
    });
    EXPECT_EQ(codeOf([&] { static_cast<void>(solver.solve(hardProgram(), context)); }),
              ErrorCode::Cancelled);
    user.join();
    std::signal(SIGINT, before);
  }
}

}  // namespace
}  // namespace hexhex::test::child_process
