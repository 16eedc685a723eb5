// The promise to whoever holds a device: no client can delay a tick. The servo loop is ticked here while the
// server, on its own thread, is flooded with commands, stalled and reconnected to. What is looked at is the
// tick's own work, not the clock: it neither allocates, locks nor does I/O (the guard ends the program),
// takes a bounded number of commands, and publishes, however far behind the other side is.

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "ipc/server.h"
#include "rt/allocation_guard.h"
#include "tests/support/raw_client.h"
#include "tests/support/servo_rig.h"
#include "tests/support/temporary_folder.h"

namespace haptic {
namespace {

constexpr std::size_t kCommandsPerTick = 8;

servo::ServoSettings settings() {
  servo::ServoSettings out;
  out.limits = test::wide_limits();
  return out;
}

void tick_guarded(test::ServoRig& rig) noexcept {
  const rt::AllocationGuard guard;
  rig.tick();
}

TEST(NoClientDelaysATick, TakesABoundedNumberOfCommands) {
  test::ServoRig rig(settings());
  while (rig.mailbox().commands.write_available() > 0) {
    rig.send(servo::CommandKind::kReset);
  }
  const std::size_t before = rig.mailbox().commands.read_available();
  ASSERT_GT(before, 10 * kCommandsPerTick);
  tick_guarded(rig);
  EXPECT_EQ(rig.mailbox().commands.read_available(), before - kCommandsPerTick);
}

TEST(NoClientDelaysATick, GoesOnWhenNobodyTakesItsEventsAndSnapshots) {
  test::ServoRig rig(settings());
  for (int i = 0; i < 2000; ++i) {
    while (rig.mailbox().commands.write_available() > 0) {
      rig.send(servo::CommandKind::kReset);
    }
    tick_guarded(rig);
  }
  // commands that could not be answered stay where they are
  EXPECT_EQ(rig.mailbox().commands.write_available(), 0U);
  EXPECT_GT(rig.mailbox().snapshots.lost(), 1900U);  // of 2000 the ring keeps 64
}

// a server of the rig's mailbox, and clients that behave as badly as they may
class Siege {
 public:
  explicit Siege(test::ServoRig& rig) {
    ipc::ServerSettings wish;
    wish.listen.emplace_back().mutable_unix()->set_path(folder_.file("s"));
    wish.role_of = [](const ipc::PeerCredentials&) { return v1::ADMIN; };
    wish.session.goodbye = std::chrono::milliseconds(50);
    server_ = std::make_unique<ipc::Server>(std::move(wish), ipc::Services{.mailbox = rig.mailbox(),
                                                                           .version = "1",
                                                                           .rate_hz = 1000.0,
                                                                           .devices = {},
                                                                           .real_time = {},
                                                                           .scene = {},
                                                                           .running = {},
                                                                           .build_scene = {},
                                                                           .edit_scene = {}});
    threads_.emplace_back([this](const std::stop_token&) { server_->run(); });
    threads_.emplace_back([this](const std::stop_token& stop) { flood(stop); });
    threads_.emplace_back([this](const std::stop_token& stop) { stall(stop); });
    threads_.emplace_back([this](const std::stop_token& stop) { reconnect(stop); });
  }
  Siege(const Siege&) = delete;
  Siege& operator=(const Siege&) = delete;
  ~Siege() {
    for (std::jthread& thread : threads_) {
      thread.request_stop();
    }
    for (std::size_t i = 1; i < threads_.size(); ++i) {
      threads_[i].join();
    }
    server_->stop();
  }

  bool has_begun() const noexcept { return answers > 0 && connections > 10 && is_stalled; }

  std::atomic<std::uint64_t> answers = 0;
  std::atomic<std::uint64_t> connections = 0;
  std::atomic<bool> is_stalled = false;

 private:
  // as many commands as are taken, without a pause
  void flood(const std::stop_token& stop) {
    test::RawClient client(server_->addresses().front());
    client.say_hello();
    while (!stop.stop_requested()) {
      client.request([](v1::Request& request) { request.mutable_reset_scene(); });
      answers += client.receive() ? 1U : 0U;
    }
  }

  // wants everything and reads nothing
  void stall(const std::stop_token& stop) {
    test::RawClient client(server_->addresses().front());
    client.say_hello();
    for (int i = 0; i < 16; ++i) {
      client.request([](v1::Request& request) {
        for (const v1::Topic topic : {v1::OBJECTS, v1::HIPS, v1::DEVICES, v1::EVENTS, v1::STATS}) {
          request.mutable_subscribe()->add_topic(topic);
        }
      });
    }
    is_stalled = true;
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  void reconnect(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      test::RawClient client(server_->addresses().front());
      client.say_hello();
      ++connections;
    }
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<ipc::Server> server_;
  std::vector<std::jthread> threads_;
};

TEST(NoClientDelaysATick, DoesItsOwnWorkOnlyUnderSiege) {
  test::ServoRig rig(settings());
  const Siege siege(rig);
  for (int i = 0; i < 10'000 && !siege.has_begun(); ++i) {
    tick_guarded(rig);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(siege.has_begun());
  for (int i = 0; i < 2000; ++i) {
    const std::size_t waiting = rig.mailbox().commands.read_available();
    tick_guarded(rig);
    // commands come meanwhile, so that fewer seem to be taken than are
    ASSERT_LE(waiting, rig.mailbox().commands.read_available() + kCommandsPerTick);
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

}  // namespace
}  // namespace haptic
