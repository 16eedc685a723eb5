#include "ipc/request_rate.h"

#include <gtest/gtest.h>

namespace haptic::ipc {
namespace {

using Verdict = RequestRate::Verdict;
using std::chrono::milliseconds;

class Rate : public testing::Test {
 protected:
  int taken_of(int requests) {
    int taken = 0;
    for (int i = 0; i < requests; ++i) {
      taken += rate_.take(now_) == Verdict::kTaken ? 1 : 0;
    }
    return taken;
  }

  RequestRate::Time now_{std::chrono::hours(1)};
  RequestRate rate_{100, now_};
};

TEST_F(Rate, LetsABurstOfOneSecondThroughAndThenAsManyAsComeDue) {
  EXPECT_EQ(taken_of(110), 100);
  now_ += milliseconds(255);  // 25.5 more
  EXPECT_EQ(taken_of(40), 25);
}

TEST_F(Rate, NeverHoldsMoreThanASecond) {
  now_ += std::chrono::hours(10);
  EXPECT_EQ(taken_of(150), 100);
}

TEST_F(Rate, CallsItAFloodAfterASecondsWorthOfRefusals) {
  EXPECT_EQ(taken_of(200), 100);  // and 100 refusals
  EXPECT_EQ(rate_.take(now_), Verdict::kFlood);
}

TEST_F(Rate, ForgivesRefusalsOfOneThatHasCalmedDown) {
  taken_of(190);
  now_ += std::chrono::seconds(1);
  EXPECT_EQ(taken_of(200), 100);
}

TEST_F(Rate, NeverForgivesOneThatGoesOnAtTwiceTheRate) {
  Verdict verdict = Verdict::kTaken;
  for (int i = 0; i < 1000 && verdict != Verdict::kFlood; ++i) {
    now_ += milliseconds(5);
    verdict = rate_.take(now_);
  }
  EXPECT_EQ(verdict, Verdict::kFlood);
}

}  // namespace
}  // namespace haptic::ipc
