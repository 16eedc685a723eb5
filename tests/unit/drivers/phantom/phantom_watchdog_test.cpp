#include "drivers/phantom/phantom_watchdog.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/support/eventually.h"

namespace haptic::drivers::phantom {
namespace {

using std::chrono::milliseconds;

TEST(PhantomWatchdog, TripsOnceWhenNobodyBeats) {
  std::atomic<int> trips{0};
  const Watchdog watchdog(milliseconds(10), [&] { ++trips; });
  ASSERT_TRUE(test::eventually([&] { return watchdog.has_tripped() && trips == 1; }));
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(trips, 1);
}

TEST(PhantomWatchdog, DoesNotTripWhileSomebodyBeats) {
  std::atomic<int> trips{0};
  Watchdog watchdog(milliseconds(5000), [&] { ++trips; });
  for (int i = 0; i < 20; ++i) {
    watchdog.beat();
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_FALSE(watchdog.has_tripped());
  EXPECT_EQ(trips, 0);
}

TEST(PhantomWatchdog, EndsWithoutATrip) {
  std::atomic<int> trips{0};
  {
    const Watchdog watchdog(milliseconds(100), [&] { ++trips; });
  }
  EXPECT_EQ(trips, 0);
}

}  // namespace
}  // namespace haptic::drivers::phantom
