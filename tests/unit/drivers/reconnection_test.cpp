#include "drivers/reconnection.h"

#include <gtest/gtest.h>

#include <vector>

namespace haptic::drivers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Reconnection, LooksFirstAfterATenthOfASecondThenEverMoreSeldomUpToFiveSeconds) {
  Reconnection plan;
  for (const int wait : {100, 200, 400, 800, 1600, 3200, 5000, 5000}) {
    EXPECT_EQ(plan.not_opened(), milliseconds(wait));
  }
}

TEST(Reconnection, LooksSoonAgainWhenSomethingWasPluggedIn) {
  Reconnection plan;
  for (int i = 0; i < 10; ++i) plan.not_opened();
  plan.plugged_in();
  EXPECT_EQ(plan.not_opened(), milliseconds(100));
}

TEST(Reconnection, LeavesADeviceThatDropsAgainAndAgainAloneForTwiceAsLongEachTime) {
  Reconnection plan;
  unsigned drops = 0;
  for (const int wait : {100, 200, 400, 800, 1600, 3200, 6400, 12800, 25600, 51200, 60000, 60000}) {
    EXPECT_EQ(plan.dropped(seconds(9)), milliseconds(wait));
    EXPECT_EQ(plan.drops(), ++drops);
  }
}

TEST(Reconnection, LookingInVainInBetweenDoesNotForgetTheDrops) {
  Reconnection plan;
  plan.dropped(seconds(1));
  plan.not_opened();
  plan.plugged_in();
  EXPECT_EQ(plan.dropped(seconds(1)), milliseconds(200));
}

TEST(Reconnection, AConnectionThatLastedForgivesTheDropsBefore) {
  Reconnection plan;
  for (int i = 0; i < 8; ++i) plan.dropped(seconds(1));
  EXPECT_EQ(plan.dropped(seconds(10)), milliseconds(100));
  EXPECT_EQ(plan.drops(), 1U);
}

}  // namespace
}  // namespace haptic::drivers
