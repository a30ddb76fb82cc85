// Progress over work in several steps: from 0 to 1, and never back.
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <base/parallel.hpp>

namespace hexhex {
namespace {

struct Reports {
  std::vector<double> shares;
  std::vector<std::string> stages;

  [[nodiscard]] Context::Progress callback() {
    return [this](std::string_view stage, double share) {
      EXPECT_GE(share, shares.empty() ? 0 : shares.back());
      shares.push_back(share);
      stages.emplace_back(stage);
    };
  }
};

constexpr std::array<WorkStep, 3> kSteps = {{{"first", 1}, {"second", 2}, {"third", 1}}};

TEST(WorkSteps, ShareTheWholeByTheirWeights) {
  Reports reports;
  Context context(1, reports.callback());
  WorkSteps steps(context, "all", kSteps);
  for (const WorkStep& step : kSteps) {
    Stage stage(context, step.name);
    context.report(step.name, 0.5);
  }
  steps.finish();
  EXPECT_EQ(reports.shares, (std::vector<double>{0, 0.125, 0.25, 0.5, 0.75, 0.875, 1}));
}

TEST(WorkSteps, AreStepsOfOthers) {
  Reports reports;
  Context context(1, reports.callback());
  WorkSteps all(context, "all", kSteps);
  { const Stage stage(context, "first"); }
  {
    WorkSteps steps(context, "second", kSteps);
    { const Stage stage(context, "first"); }
    const Stage stage(context, "third");
    context.report("third", 1);
    steps.finish();
  }
  const Stage stage(context, "third");
  all.finish();
  EXPECT_EQ(reports.shares, (std::vector<double>{0, 0.25, 0.625, 0.75, 0.75, 1}));
}

TEST(WorkSteps, BeginWithZeroWhereFirstOnesDoNotOccur) {
  Reports reports;
  Context context(1, reports.callback());
  WorkSteps steps(context, "all", kSteps);
  {
    const Stage stage(context, "second");
    context.report("second", 0.5);
  }
  const Stage stage(context, "third");
  EXPECT_EQ(reports.shares, (std::vector<double>{0, 1.0 / 3, 2.0 / 3}));
}

TEST(WorkSteps, NeverGoBack) {
  Reports reports;
  Context context(1, reports.callback());
  WorkSteps steps(context, "all", kSteps);
  for (const char* name : {"second", "unknown", "second", "first", "third"}) {
    Stage stage(context, name);
    context.report(name, 1);
  }
  steps.finish();
  EXPECT_EQ(reports.shares.back(), 1);
  EXPECT_EQ(reports.stages.back(), "third");
}

TEST(WorkSteps, BeginAnewWithEachCall) {
  Reports reports;
  Context context(1, [&](std::string_view, double share) { reports.shares.push_back(share); });
  for (int call = 0; call < 2; ++call) {
    WorkSteps steps(context, "all", kSteps);
    steps.finish();  // of nothing
  }
  context.report("own", 0.5);
  EXPECT_EQ(reports.shares, (std::vector<double>{1, 1, 0.5}));
}

TEST(Stage, HasOneProgressForAllItsLoops) {
  for (const int threads : {1, 4}) {
    Reports reports;
    Context context(threads, reports.callback());
    Stage stage(context, "loops");
    stage.setTotal(4000);
    for (int loop = 0; loop < 4; ++loop) {
      withThreads(threads, [&] { parallelFor(stage, 1000, 100, [](std::size_t) {}); });
      if (threads == 1) {
        EXPECT_NEAR(reports.shares.back(), 0.25 * (loop + 1), 1e-12);
      }
    }
    EXPECT_LE(reports.shares.back(), 1);
  }
}

}  // namespace
}  // namespace hexhex
