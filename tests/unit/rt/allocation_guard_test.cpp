#include "rt/allocation_guard.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace haptic::rt {
namespace {

// Each action runs in a child process, which must end with the guard's message.
class AllocationGuardDeathTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!kAllocationGuardWorks) GTEST_SKIP() << "a sanitizer interposes the same functions";
  }
};

// volatile, so that no pair of new and delete is optimised away
int* volatile sink = nullptr;

TEST_F(AllocationGuardDeathTest, NewEndsTheProgram) {
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        sink = new int(1);
      },
      "servo path: malloc");
}

TEST_F(AllocationGuardDeathTest, DeleteEndsTheProgram) {
  sink = new int(1);
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        delete sink;
      },
      "servo path: free");
  delete sink;
}

TEST_F(AllocationGuardDeathTest, AGrowingVectorEndsTheProgram) {
  std::vector<int> numbers(4);
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        numbers.resize(numbers.capacity() + 1);
      },
      "servo path: malloc");
}

TEST_F(AllocationGuardDeathTest, LockingAMutexEndsTheProgram) {
  std::mutex mutex;
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        mutex.lock();
      },
      "servo path: pthread_mutex_lock");
}

TEST_F(AllocationGuardDeathTest, AnExceptionEndsTheProgram) {
  // the exception object itself is allocated by malloc, which is what is seen first
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        throw 1;
      },
      "servo path: (malloc|throw)");
}

TEST_F(AllocationGuardDeathTest, WritingReadingAndOpeningAFileEndTheProgram) {
  char byte = 'x';
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        static_cast<void>(::write(STDOUT_FILENO, &byte, 1) == 1);
      },
      "servo path: write");
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        static_cast<void>(::read(STDIN_FILENO, &byte, 1) == 1);
      },
      "servo path: read");
  EXPECT_DEATH(
      {
        const AllocationGuard guard;
        static_cast<void>(::open("/dev/null", O_RDONLY));
      },
      "servo path: open");
}

TEST(AllocationGuard, PermitsEverythingAgainOnceItIsGone) {
  { const AllocationGuard guard; }
  const std::vector<int> numbers(100, 1);
  EXPECT_EQ(numbers.size(), 100u);
  EXPECT_THROW(throw std::runtime_error("caught"), std::runtime_error);
}

TEST(AllocationGuard, WatchesItsOwnThreadOnly) {
  std::unique_ptr<int> made;
  std::thread other;
  std::atomic<bool> go{false};
  other = std::thread([&] {
    while (!go) std::this_thread::yield();
    made = std::make_unique<int>(7);
    go = false;
  });
  {
    const AllocationGuard guard;
    go = true;
    while (go) std::this_thread::yield();
  }
  other.join();
  EXPECT_EQ(*made, 7);
}

}  // namespace
}  // namespace haptic::rt
