#include "service/signals.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>

#include "tests/support/eventually.h"

namespace haptic::service {
namespace {

struct Counts {
  std::atomic<int> reloads{0};
  std::atomic<int> stops{0};
};

class SignalThreadTest : public testing::Test {
 protected:
  Signals signals_;
  Counts counts_;
};

TEST_F(SignalThreadTest, ReloadsAtEachHangupAndGoesOn) {
  const SignalThread thread(
      signals_, [&] { ++counts_.reloads; }, [&] { ++counts_.stops; });
  for (int i = 1; i <= 3; ++i) {
    ::kill(::getpid(), SIGHUP);
    ASSERT_TRUE(test::eventually([&] { return counts_.reloads == i; }));
  }
  EXPECT_EQ(counts_.stops, 0);
}

TEST_F(SignalThreadTest, StopsAtTheSignalOfTheServiceManager) {
  const SignalThread thread(
      signals_, [&] { ++counts_.reloads; }, [&] { ++counts_.stops; });
  ::kill(::getpid(), SIGTERM);
  EXPECT_TRUE(test::eventually([&] { return counts_.stops == 1; }));
  EXPECT_EQ(counts_.reloads, 0);
}

TEST_F(SignalThreadTest, StopsOnceInTheEndIfNoSignalCame) {
  {
    const SignalThread thread(
        signals_, [&] { ++counts_.reloads; }, [&] { ++counts_.stops; });
  }
  EXPECT_EQ(counts_.stops, 1);
}

TEST_F(SignalThreadTest, HearsASignalThatCameBeforeIt) {
  ::kill(::getpid(), SIGHUP);
  const SignalThread thread(
      signals_, [&] { ++counts_.reloads; }, [&] { ++counts_.stops; });
  EXPECT_TRUE(test::eventually([&] { return counts_.reloads == 1; }));
}

}  // namespace
}  // namespace haptic::service
