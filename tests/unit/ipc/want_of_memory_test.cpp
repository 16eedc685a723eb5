// Memory runs out in the middle of whatever the io thread does: the reserve serves it, once, and no client
// notices.

#include <gtest/gtest.h>

#include <atomic>

#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "rt/memory_reserve.h"
#include "tests/support/failing_allocation.h"
#include "tests/support/test_daemon.h"

namespace haptic::ipc {
namespace {

using client::Connection;

constexpr std::size_t kBytes = std::size_t{4} * 1024 * 1024;

std::atomic<int> times_told{0};
void count() noexcept { ++times_told; }

v1::Response ask(Connection& daemon, const std::function<void(v1::Request&)>& fill) {
  v1::Request request;
  fill(request);
  return daemon.call(std::move(request));
}

// a client comes, looks, drives, asks for what it does not get, and goes
void converse(const std::string& address) {
  client::Options options;
  options.address = address;
  Connection daemon(options);
  EXPECT_EQ(daemon.daemon().version(), "9.9");
  EXPECT_EQ(ask(daemon, [](v1::Request& request) { request.mutable_get_status(); }).status().hips(), 2U);
  EXPECT_EQ(ask(daemon, [](v1::Request& request) { request.mutable_get_scene(); }).scene().scene().name(),
            "example");
  const std::uint32_t subscription = daemon.subscribe({v1::EVENTS, v1::OBJECTS, v1::HIPS}, 1);
  ask(daemon, [](v1::Request& request) { request.mutable_acquire_drive(); });
  ask(daemon, [](v1::Request& request) { request.mutable_arm(); });
  ask(daemon, [](v1::Request& request) { request.mutable_disarm(); });
  EXPECT_THROW(ask(daemon, [](v1::Request& request) { request.mutable_step(); }), client::Error);
  daemon.unsubscribe(subscription);
}

TEST(WantOfMemory, IsServedWhereverItIsFeltAndToldOnce) {
  test::TestDaemon daemon({}, [] { test::make_this_thread_fallible(); });
  converse(daemon.address());
  std::uint64_t spared = 0;
  for (std::uint64_t failures = 1; failures > 0; ++spared) {
    times_told = 0;
    const rt::MemoryReserve reserve(kBytes, &count);
    test::fail_allocations(spared, 1);
    converse(daemon.address());
    failures = test::stop_failing();
    ASSERT_EQ(reserve.is_spent(), failures > 0) << "after " << spared;
    ASSERT_EQ(times_told, failures > 0 ? 1 : 0) << "after " << spared;
  }
  EXPECT_GT(spared, 100U);  // each of so many has failed in its turn
}

}  // namespace
}  // namespace haptic::ipc
