// Numbers for keys, against a map of the standard library.
#include <map>
#include <rapidcheck.h>
#include <vector>

#include <adjacency/key_table.hpp>
#include <gtest/gtest.h>

namespace hexhex::adjacency {
namespace {

TEST(KeyTable, NumbersKeysInTheOrderInWhichTheyCome) {
  const bool passed = rc::check([] {
    KeyTable table;
    // Several times, as slots are not emptied; few keys that repeat, or enough to make it grow.
    for (int round = 0; round < 3; ++round) {
      table.clear();
      const int range = *rc::gen::element(8, 300, 5000);
      const int step = *rc::gen::element(1, 4096, 1 << 19);
      std::map<Index, Index> expected;
      const bool one = *rc::gen::arbitrary<bool>();  // by one; otherwise in a loop
      const std::vector<int> picks =
          *rc::gen::container<std::vector<int>>(800, rc::gen::inRange(0, range));
      if (!one) table.makeRoom(picks.size());
      const KeyTable::Numberer number = table.numberer();
      for (const int pick : picks) {
        const auto key = static_cast<Index>(pick) * static_cast<Index>(step);
        const auto size = static_cast<Index>(expected.size());
        const Index wanted = expected.try_emplace(key, size).first->second;
        RC_ASSERT((one ? table.insert(key) : number(key, size)) == wanted);
      }
      if (one) RC_ASSERT(table.size() == expected.size());
    }
  });
  EXPECT_TRUE(passed);
}

}  // namespace
}  // namespace hexhex::adjacency
