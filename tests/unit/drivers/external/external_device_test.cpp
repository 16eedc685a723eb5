// The device with its thread and its socket, and programs that serve it through the C client or, where that
// is too well-mannered, by plain sockets.

#include "drivers/external/external_device.h"

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <functional>
#include <thread>

#include "drivers/device_error.h"
#include "proto/device/haptic_device.h"
#include "rt/tick_clock.h"
#include "tests/support/temporary_folder.h"

namespace haptic::drivers::external {
namespace {

using std::chrono::milliseconds;

constexpr int kPatienceMs = 5000;

/// A program on the C client.
class Program {
 public:
  explicit Program(const std::string& path) { EXPECT_EQ(haptic_device_open(&device_, path.c_str()), 0); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { haptic_device_close(&device_); }

  int exchange(double x, int wait_ms = kPatienceMs) {
    haptic_sample sample{};
    sample.time_ns = haptic_device_now();
    sample.position[0] = x;
    sample.orientation[0] = 1.0;
    return haptic_device_exchange(&device_, &sample, wait_ms);
  }

  double force_x() const {
    double force[3];
    double torque[3];
    haptic_device_force(&device_, force, torque);
    return force[0];
  }

  /// Waits until it is refused; what for.
  unsigned wait_for_refusal() {
    haptic_force last{};
    pollfd readable{device_.socket, POLLIN, 0};
    while (::poll(&readable, 1, kPatienceMs) > 0) {
      const ssize_t size = ::recv(device_.socket, &last, sizeof(last), MSG_DONTWAIT);
      if (size == 0) return HAPTIC_NOT_REFUSED;  // ended without a word
      if (size == sizeof(last) && last.kind == HAPTIC_REFUSED) return last.refusal;
    }
    return HAPTIC_NOT_REFUSED;
  }

  unsigned refusal() const { return device_.newest.refusal; }
  const haptic_force& newest() const { return device_.newest; }
  void send_raw(const void* bytes, std::size_t size) const {
    EXPECT_EQ(::send(device_.socket, bytes, size, MSG_NOSIGNAL), static_cast<ssize_t>(size));
  }
  void disappear() { haptic_device_close(&device_); }

 private:
  haptic_device device_{};
};

class External : public testing::Test {
 protected:
  External() { device_->start(); }

  bool read(DeviceSample& sample) { return device_->read(rt::monotonic_ns(), sample); }

  /// Waits for it; whether it came.
  static bool wait_until(const std::function<bool()>& holds) {
    const Nanoseconds end = rt::monotonic_ns() + kPatienceMs * 1'000'000LL;
    while (!holds()) {
      if (rt::monotonic_ns() > end) return false;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return true;
  }

  bool has_no_sample() {
    DeviceSample sample;
    return wait_until([&] { return !read(sample); });
  }

  void write(double force_x, Nanoseconds lifetime = 3'000'000) {
    const Nanoseconds now = rt::monotonic_ns();
    device_->write(now, {.expires = now + lifetime, .force = {force_x, 0.0, 0.0}});
  }

  test::TemporaryFolder folder_;
  std::string path_ = folder_.file("left.sock");
  std::unique_ptr<Device> device_ = make_external({.name = "left", .path = path_});
};

TEST_F(External, HasTheSamplesOfTheProgramThatServesIt) {
  DeviceSample sample;
  EXPECT_FALSE(read(sample));
  Program program(path_);
  ASSERT_EQ(program.exchange(0.25), 0);
  ASSERT_TRUE(read(sample));
  EXPECT_EQ(sample.position, glm::dvec3(0.25, 0.0, 0.0));
  EXPECT_LE(sample.time, rt::monotonic_ns());
}

TEST_F(External, IsAbsentUntilAProgramServesItAndLostWhenThatEnds) {
  const auto reaches = [&](DevicePhase phase) {
    return wait_until([&] { return device_->state().phase == phase; });
  };
  EXPECT_TRUE(wait_until([&] { return device_->words().reason == "no program serves it at " + path_; }));
  EXPECT_EQ(device_->state().phase, DevicePhase::kAbsent);
  {
    Program program(path_);
    EXPECT_TRUE(reaches(DevicePhase::kOpening)) << "it has sent no sample yet";
    ASSERT_EQ(program.exchange(0.0), 0);
    EXPECT_TRUE(reaches(DevicePhase::kReady));
    EXPECT_EQ(device_->words().reason, "");
  }
  EXPECT_TRUE(reaches(DevicePhase::kAbsent));
  EXPECT_TRUE(wait_until([&] {
    return device_->words().reason.find("has ended the connection; no program serves it") !=
           std::string::npos;
  }));
  EXPECT_EQ(device_->state().losses, 1U);
}

TEST_F(External, AnswersEachSampleWithTheForceThatIsAlive) {
  Program program(path_);
  ASSERT_EQ(program.exchange(0.0), 0);
  EXPECT_EQ(program.newest().sequence, 1U);
  EXPECT_EQ(program.newest().force[0], 0.0);
  // written again, as a machine under load may be slower than 3 ms
  EXPECT_TRUE(wait_until([&] {
    write(1.5);
    return program.exchange(0.0) == 0 && program.force_x() == 1.5;
  }));
  EXPECT_LE(program.newest().expires_ns, rt::monotonic_ns() + 3'000'000);
  EXPECT_TRUE(wait_until([&] { return program.force_x() == 0.0; })) << "it expires at the program";
  ASSERT_EQ(program.exchange(0.0), 0);
  EXPECT_EQ(program.newest().force[0], 0.0) << "and at the daemon";
}

TEST_F(External, PlacesTheDevicesFrameInTheWorld) {
  const std::string path = folder_.file("right.sock");
  const auto device =
      make_external({.name = "right", .path = path, .world_from_base = {.position = {1.0, 2.0, 3.0}}});
  device->start();
  Program program(path);
  ASSERT_EQ(program.exchange(0.25), 0);
  DeviceSample sample;
  ASSERT_TRUE(device->read(rt::monotonic_ns(), sample));
  EXPECT_EQ(sample.position, glm::dvec3(1.25, 2.0, 3.0));
}

TEST_F(External, AProgramThatVanishesLeavesNoSample) {
  Program program(path_);
  ASSERT_EQ(program.exchange(0.0), 0);
  program.disappear();
  EXPECT_TRUE(has_no_sample());
}

// Its pose is not to be taken for a move of the former one's, so the servo must have seen that there is none.
TEST_F(External, TheNextProgramIsLetInAfterAPause) {
  {
    Program first(path_);
    ASSERT_EQ(first.exchange(0.0), 0);
  }
  const Nanoseconds gone = rt::monotonic_ns();
  Program second(path_);
  ASSERT_EQ(second.exchange(0.5), 0);
  EXPECT_GE(rt::monotonic_ns() - gone, 99'000'000);
  DeviceSample sample;
  ASSERT_TRUE(read(sample));
  EXPECT_EQ(sample.position.x, 0.5);
}

TEST_F(External, ServesOneProgramAtATime) {
  Program first(path_);
  ASSERT_EQ(first.exchange(0.25), 0);
  Program second(path_);
  EXPECT_EQ(second.wait_for_refusal(), HAPTIC_BUSY);
  ASSERT_EQ(first.exchange(0.5), 0) << "the first one is not disturbed";
  DeviceSample sample;
  ASSERT_TRUE(read(sample));
  EXPECT_EQ(sample.position.x, 0.5);
}

TEST_F(External, TheClientTellsWhyItWasRefused) {
  Program first(path_);
  ASSERT_EQ(first.exchange(0.25), 0);
  Program second(path_);
  int error = 0;
  for (int i = 0; i < 100 && error == 0; ++i) error = second.exchange(0.0, 50);
  EXPECT_EQ(error, -EPROTO);
  EXPECT_EQ(second.refusal(), HAPTIC_BUSY);
  EXPECT_EQ(second.exchange(0.0), -ENOTCONN);
}

TEST_F(External, GarbageOfAnySizeEndsTheConnectionAndTheSample) {
  for (const std::size_t size : {1U, 5U, 80U, 111U, 112U, 113U, 256U, 60'000U}) {
    SCOPED_TRACE(size);
    Program program(path_);
    ASSERT_EQ(program.exchange(0.0), 0);
    const std::string garbage(size, '\x5a');
    program.send_raw(garbage.data(), garbage.size());
    EXPECT_EQ(program.wait_for_refusal(), HAPTIC_MALFORMED);
    EXPECT_TRUE(has_no_sample());
  }
}

TEST_F(External, AnotherVersionIsToldFromGarbage) {
  Program program(path_);
  haptic_sample sample{};
  sample.magic = HAPTIC_DEVICE_MAGIC;
  sample.version = HAPTIC_DEVICE_VERSION + 1;
  program.send_raw(&sample, sizeof(sample));
  EXPECT_EQ(program.wait_for_refusal(), HAPTIC_OTHER_VERSION);
}

TEST_F(External, AProgramThatIsSilentForASecondIsCutOff) {
  Program program(path_);
  const Nanoseconds start = rt::monotonic_ns();
  ASSERT_EQ(program.exchange(0.0), 0);
  EXPECT_EQ(program.wait_for_refusal(), HAPTIC_SILENT);
  EXPECT_GE(rt::monotonic_ns() - start, 990'000'000);
  EXPECT_TRUE(has_no_sample());
}

TEST_F(External, ASilentProgramsSampleKeepsItsTimeAndSoGrowsOld) {
  Program program(path_);
  ASSERT_EQ(program.exchange(0.0), 0);
  DeviceSample first;
  ASSERT_TRUE(read(first));
  std::this_thread::sleep_for(milliseconds(30));
  DeviceSample later;
  ASSERT_TRUE(read(later));
  EXPECT_EQ(later.time, first.time);
}

TEST_F(External, StoppingTellsTheProgramAndRemovesTheSocket) {
  Program program(path_);
  ASSERT_EQ(program.exchange(0.0), 0);
  device_->stop();
  EXPECT_EQ(program.wait_for_refusal(), HAPTIC_STOPPED);
  struct stat status {};
  EXPECT_NE(::stat(path_.c_str(), &status), 0);
  DeviceSample sample;
  EXPECT_FALSE(read(sample));
  device_->start();
  Program again(path_);
  EXPECT_EQ(again.exchange(0.0), 0);
}

TEST_F(External, AProgramThatDoesNotReadItsForcesIsServedAllTheSame) {
  Program program(path_);
  haptic_sample sample{};
  sample.magic = HAPTIC_DEVICE_MAGIC;
  sample.version = HAPTIC_DEVICE_VERSION;
  sample.kind = HAPTIC_SAMPLE;
  sample.orientation[0] = 1.0;
  constexpr std::uint64_t kMany = 5000;
  for (sample.sequence = 1; sample.sequence <= kMany; ++sample.sequence) {
    sample.time_ns = haptic_device_now();
    sample.buttons = static_cast<std::uint32_t>(sample.sequence);
    program.send_raw(&sample, sizeof(sample));
  }
  DeviceSample newest;
  EXPECT_TRUE(wait_until([&] { return read(newest) && newest.buttons == kMany; }));
}

// In a child process, as another user.
TEST_F(External, RefusesAProgramOfAUserWhoMayNot) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can be somebody else";
  const auto attempt = [&](const std::string& path) {
    const pid_t child = ::fork();
    if (child == 0) {
      if (::setgroups(0, nullptr) != 0 || ::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(100);
      haptic_device device;
      if (haptic_device_open(&device, path.c_str()) != 0) ::_exit(101);
      haptic_sample sample{};
      sample.time_ns = haptic_device_now();
      sample.orientation[0] = 1.0;
      int error = 0;
      for (int i = 0; i < 20 && error == 0 && device.newest.kind == 0; ++i) {
        sample.time_ns = haptic_device_now();
        error = haptic_device_exchange(&device, &sample, 200);
      }
      ::_exit(error == 0 ? 0 : static_cast<int>(device.newest.refusal));
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  };
  ASSERT_EQ(::chmod(folder_.file("").c_str(), 0755), 0);
  EXPECT_EQ(attempt(path_), 101) << "only the daemon's user may even connect";
  const std::string daemon = folder_.file("daemon.sock");
  const std::string nobody = folder_.file("nobody.sock");
  const auto for_daemon = make_external({.name = "a", .path = daemon, .users = {"daemon"}});
  const auto for_nobody = make_external({.name = "b", .path = nobody, .users = {"nobody"}});
  for_daemon->start();
  for_nobody->start();
  EXPECT_EQ(attempt(daemon), HAPTIC_NOT_PERMITTED);
  EXPECT_EQ(attempt(nobody), 0);
}

std::string error_of_start(const ExternalSettings& settings) {
  try {
    make_external(settings)->start();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST_F(External, TellsWhyItCannotListen) {
  EXPECT_EQ(error_of_start({.name = "b", .path = path_}),
            "device \"b\": cannot listen on " + path_ + ": another program listens there");
  const std::string file = folder_.write("file", "precious");
  EXPECT_EQ(error_of_start({.name = "b", .path = file}),
            "device \"b\": cannot listen on " + file + ": there is a file of that name which is no socket");
  EXPECT_NE(error_of_start({.name = "b", .path = folder_.file("none/b.sock")}).find("No such file"),
            std::string::npos);
  EXPECT_EQ(error_of_start({.name = "b", .path = folder_.file("b.sock"), .users = {"no such user"}}),
            "device \"b\": there is no user \"no such user\", who is to serve it");
}

TEST_F(External, TakesThePlaceOfASocketThatADeadDaemonLeft) {
  const std::string path = folder_.file("stale.sock");
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof(name.sun_path) - 1);
  const int dead = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  ASSERT_EQ(::bind(dead, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  ::close(dead);
  EXPECT_EQ(error_of_start({.name = "b", .path = path}), "");
}

}  // namespace
}  // namespace haptic::drivers::external
