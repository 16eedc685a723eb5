#include "rt/memory_reserve.h"

#include <gtest/gtest.h>

#include <new>

#include "tests/support/failing_allocation.h"

namespace haptic::rt {
namespace {

constexpr std::size_t kBytes = 4096;

int times_told = 0;
void count() noexcept { ++times_told; }

// called by name, so that no compiler leaves it away
void use_memory() { ::operator delete(::operator new(16)); }

class MemoryReserveTest : public testing::Test {
 protected:
  void SetUp() override {
    times_told = 0;
    test::make_this_thread_fallible();
  }
  void TearDown() override { test::stop_failing(); }
};

TEST_F(MemoryReserveTest, ServesTheFirstAllocationThatFailsAndTellsOnce) {
  const MemoryReserve reserve(kBytes, &count);
  EXPECT_FALSE(reserve.is_spent());
  test::fail_allocations(0, 1);
  EXPECT_NO_THROW(use_memory());
  EXPECT_TRUE(reserve.is_spent());
  EXPECT_EQ(times_told, 1);
}

TEST_F(MemoryReserveTest, EndsTheProgramWhenItIsNotEnough) {
  const MemoryReserve reserve(kBytes, &count);
  EXPECT_DEATH(
      {
        test::fail_allocations(0, 2);
        use_memory();
      },
      "");
}

TEST_F(MemoryReserveTest, IsNotForWorkThatMayFail) {
  const MemoryReserve reserve(kBytes, &count);
  {
    const MemoryMayRunOut tolerated;
    test::fail_allocations(0, 1);
    EXPECT_THROW(use_memory(), std::bad_alloc);
  }
  EXPECT_FALSE(reserve.is_spent());
  EXPECT_EQ(times_told, 0);
}

TEST_F(MemoryReserveTest, GoesWithItsOwner) {
  { const MemoryReserve reserve(kBytes, &count); }
  test::fail_allocations(0, 1);
  EXPECT_THROW(use_memory(), std::bad_alloc);
}

}  // namespace
}  // namespace haptic::rt
