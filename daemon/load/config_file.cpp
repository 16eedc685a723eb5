#include "load/config_file.h"

#include <arpa/inet.h>
#include <sys/un.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "load/device_config.h"
#include "load/path_file.h"
#include "load/phantom_calibration.h"
#include "load/ranges.h"
#include "load/read_file.h"
#include "load/safety_config.h"
#include "load/scene_parts.h"

namespace haptic::load {
namespace {

constexpr std::uint32_t kKibi = 1024;
constexpr std::uint32_t kMebi = 1024 * kKibi;
constexpr double kLongestDelay = 1.0;  // s; a simulated device keeps no older samples

/// Fills one section after the other and checks it.
class ConfigCheck {
 public:
  ConfigCheck(v1::DaemonConfig& config, const TextSource& source, const std::filesystem::path& file)
      : config_(config), source_(source), file_(file) {}

  void check(LoadedConfig& loaded) {
    servo(*config_.mutable_servo());
    capacity(*config_.mutable_capacity());
    check_safety(source_, *config_.mutable_safety());
    listeners();
    limits(*config_.mutable_limits());
    drive(*config_.mutable_drive());
    flight_recorder(*config_.mutable_flight_recorder());
    log(*config_.mutable_log());
    metrics();
    if (!config_.scene().empty()) config_.set_scene(relative_to(file_, config_.scene()).string());
    devices(loaded);
  }

 private:
  // 0 is a field that was left away: proto3 cannot tell the two apart, and 0 is never a value of these
  void number(const std::string& field, double value, double fallback, const Range& range, auto set) const {
    if (value == 0.0) return set(fallback);
    check_range(source_, field, value, range);
  }
  void count(const std::string& field, std::uint32_t value, std::uint32_t fallback, const Range& range,
             auto set) const {
    if (value == 0) return set(fallback);
    check_range(source_, field, value, range);
  }

  void servo(v1::Servo& servo) const {
    number("servo.rate_hz", servo.rate_hz(), 1000.0, {100.0, 8000.0, " Hz"},
           [&](double v) { servo.set_rate_hz(v); });
    count("servo.priority", servo.priority(), 80, {1, 99}, [&](std::uint32_t v) { servo.set_priority(v); });
    if (servo.has_cpu()) check_range(source_, "servo.cpu", servo.cpu(), {0, 1023});
  }

  void capacity(v1::Capacity& capacity) const {
    count("capacity.objects", capacity.objects(), 256, {1, 65536},
          [&](std::uint32_t v) { capacity.set_objects(v); });
    count("capacity.fingers", capacity.fingers(), 64, {1, 4096},
          [&](std::uint32_t v) { capacity.set_fingers(v); });
    count("capacity.hips", capacity.hips(), 16384, {1, 262144},
          [&](std::uint32_t v) { capacity.set_hips(v); });
  }

  void limits(v1::Limits& limits) const {
    count("limits.clients", limits.clients(), 64, {1, 4096}, [&](std::uint32_t v) { limits.set_clients(v); });
    count("limits.clients_per_user", limits.clients_per_user(), 32, {1, 4096},
          [&](std::uint32_t v) { limits.set_clients_per_user(v); });
    count("limits.subscriptions", limits.subscriptions(), 16, {1, 1024},
          [&](std::uint32_t v) { limits.set_subscriptions(v); });
    count("limits.pending_data", limits.pending_data(), 4 * kMebi, {4 * kKibi, 1024 * kMebi, " bytes"},
          [&](std::uint32_t v) { limits.set_pending_data(v); });
    count("limits.pending_control", limits.pending_control(), 4 * kMebi, {4 * kKibi, 1024 * kMebi, " bytes"},
          [&](std::uint32_t v) { limits.set_pending_control(v); });
    count("limits.requests_per_second", limits.requests_per_second(), 2000, {1, 1000000},
          [&](std::uint32_t v) { limits.set_requests_per_second(v); });
    number("limits.hello", limits.hello(), 5.0, {0.1, 3600.0, " s"}, [&](double v) { limits.set_hello(v); });
    count("limits.greeting_bytes", limits.greeting_bytes(), 64 * kKibi, {kKibi, kMebi, " bytes"},
          [&](std::uint32_t v) { limits.set_greeting_bytes(v); });
    count("limits.request_bytes", limits.request_bytes(), kMebi, {kKibi, 64 * kMebi, " bytes"},
          [&](std::uint32_t v) { limits.set_request_bytes(v); });
    count("limits.open_requests", limits.open_requests(), 32, {1, 4096},
          [&](std::uint32_t v) { limits.set_open_requests(v); });
    count("limits.items", limits.items(), std::max(16384U, config_.capacity().hips()), {1, 1 << 20},
          [&](std::uint32_t v) { limits.set_items(v); });
  }

  void drive(v1::Drive& drive) const {
    if (drive.on_loss() == v1::Drive::ON_LOSS_UNSPECIFIED) drive.set_on_loss(v1::Drive::FAULT);
    if (drive.on_loss() < v1::Drive::FAULT || drive.on_loss() > v1::Drive::KEEP) {
      source_.fail("drive.on_loss", "is no policy (permitted: FAULT, DISARM, KEEP)");
    }
    number("drive.heartbeat", drive.heartbeat(), 0.1, {0.01, 10.0, " s"},
           [&](double v) { drive.set_heartbeat(v); });
  }

  void flight_recorder(v1::FlightRecorder& recorder) const {
    if (!recorder.directory().empty()) {
      recorder.set_directory(relative_to(file_, recorder.directory()).string());
    }
    number("flight_recorder.seconds", recorder.seconds(), 2.0, {0.1, 60.0, " s"},
           [&](double v) { recorder.set_seconds(v); });
    count("flight_recorder.keep", recorder.keep(), 20, {1, 10000},
          [&](std::uint32_t v) { recorder.set_keep(v); });
  }

  void log(v1::Log& log) const {
    if (log.level() == v1::Log::LEVEL_UNSPECIFIED) log.set_level(v1::Log::INFO);
    if (log.level() < v1::Log::DEBUG || log.level() > v1::Log::ERROR) {
      source_.fail("log.level", "is no level (permitted: DEBUG, INFO, WARNING, ERROR)");
    }
    if (!log.file().empty()) log.set_file(relative_to(file_, log.file()).string());
    if (log.file_bytes() == 0) return log.set_file_bytes(10'000'000);
    check_range(source_, "log.file_bytes", static_cast<double>(log.file_bytes()), {4096, 1e12, " bytes"});
  }

  void metrics() const {
    const std::uint32_t port = config_.metrics().port();
    if (port != 0) check_range(source_, "metrics.port", port, {1, 65535});
  }

  void devices(LoadedConfig& loaded) {
    if (config_.device_size() > kMostDevices) {
      source_.fail(item("device", kMostDevices),
                   "is one device too many (permitted: 0 to " + std::to_string(kMostDevices) + ")");
    }
    std::map<std::string, int> names;
    for (int i = 0; i < config_.device_size(); ++i) {
      const std::string field = item("device", i);
      v1::Device& device = *config_.mutable_device(i);
      if (device.name().empty()) source_.fail(field + ".name", "is missing: a device needs a name");
      const auto [same, is_new] = names.emplace(device.name(), i);
      if (!is_new) {
        source_.fail(field + ".name",
                     in_quotes(device.name()) + " is also the name of " + item("device", same->second));
      }
      check_device_safety(source_, field, device);
      loaded.paths.push_back(path_of(field, device));
      loaded.firmware.push_back(check_hardware(source_, field, file_, device));
      loaded.calibrations.push_back(check_phantom(source_, field, file_, device));
      if (device.has_fastrak()) share_tracker(field + ".fastrak", device.fastrak());
    }
  }

  // stations of one tracker share its port, and whatever holds for all of it
  void share_tracker(const std::string& field, const v1::Device::Fastrak& device) {
    const auto [tracker, is_new] = trackers_.emplace(device.port(), device);
    if (!is_new && device.baud() != tracker->second.baud()) {
      source_.fail(field + ".baud", "is another one than that of the other stations on this port");
    }
    if (!is_new && device.model() != tracker->second.model()) {
      source_.fail(field + ".model", "is another one than that of the other stations on this port");
    }
    if (!stations_.insert(device.port() + ":" + std::to_string(device.station())).second) {
      source_.fail(field + ".station", std::to_string(device.station()) + " of this port is another device");
    }
  }

  std::vector<drivers::PathPoint> path_of(const std::string& field, v1::Device& device) {
    switch (device.driver_case()) {
      case v1::Device::kSimulated:
        return simulated(field + ".simulated", *device.mutable_simulated());
      case v1::Device::kPlayback:
        return path(field + ".playback.path", *device.mutable_playback()->mutable_path());
      case v1::Device::kVirtual:
        return {};
      case v1::Device::kExternal:
        external(field + ".external", *device.mutable_external());
        return {};
      case v1::Device::DRIVER_NOT_SET:
        source_.fail(field, "has no driver (permitted: " + known_drivers() + ")");
      default:
        return {};
    }
  }

  std::vector<drivers::PathPoint> simulated(const std::string& field, v1::Device::Simulated& device) {
    check_range(source_, field + ".mass", device.mass(), {0.0, 1e3, " kg", true});
    check_range(source_, field + ".damping", device.damping(), {0.0, 1e6, " N s/m"});
    for (int i = 0; i < device.fault_size(); ++i) {
      injected_fault(field + "." + item("fault", i), device.fault(i));
    }
    if (!device.has_hand()) return {};
    check_range(source_, field + ".hand.stiffness", device.hand().stiffness(), {0.0, 1e6, " N/m", true});
    check_range(source_, field + ".hand.damping", device.hand().damping(), {0.0, 1e6, " N s/m"});
    return path(field + ".hand.path", *device.mutable_hand()->mutable_path());
  }

  void injected_fault(const std::string& field, const v1::Device::Simulated::InjectedFault& fault) const {
    using Fault = v1::Device::Simulated::InjectedFault;
    if (fault.kind() <= Fault::KIND_UNSPECIFIED || fault.kind() > Fault::Kind_MAX) {
      source_.fail(field + ".kind",
                   "is missing (permitted: DROP, DELAY, FREEZE, NOT_A_NUMBER, JUMP, UNPLUG)");
    }
    check_range(source_, field + ".at", fault.at(), {0.0, 1e6, " s"});
    check_range(source_, field + ".duration", fault.duration(), {0.0, 1e6, " s"});
    if (fault.kind() == Fault::DELAY) {
      check_range(source_, field + ".delay", fault.delay(), {0.0, kLongestDelay, " s", true});
    } else if (fault.delay() != 0.0) {
      source_.fail(field + ".delay", "is of the kind DELAY only");
    }
    if (fault.kind() == Fault::JUMP) {
      if (!fault.has_offset()) source_.fail(field + ".offset", "is missing: a JUMP goes somewhere");
      make_point(source_, field + ".offset", fault.offset());
    } else if (fault.has_offset()) {
      source_.fail(field + ".offset", "is of the kind JUMP only");
    }
  }

  void external(const std::string& field, v1::Device::External& device) {
    if (device.path().empty()) source_.fail(field + ".path", "is missing: expected the path of a socket");
    device.set_path(relative_to(file_, device.path()).string());
    check_socket_length(field + ".path", device.path());
    if (!sockets_.insert(device.path()).second) {
      source_.fail(field + ".path", in_quotes(device.path()) + " is also the socket of another device");
    }
    for (int i = 0; i < device.user_size(); ++i) {
      if (device.user(i).empty()) source_.fail(field + "." + item("user", i), "is empty");
    }
    check_range(source_, field + ".max_force", device.max_force(), {0.0, 1000.0, " N"});
  }

  void check_socket_length(const std::string& field, const std::string& path) const {
    constexpr std::size_t kLongest = sizeof(sockaddr_un::sun_path) - 1;
    if (path.size() <= kLongest) return;
    source_.fail(field, "has " + std::to_string(path.size()) + " bytes (permitted: up to " +
                            std::to_string(kLongest) + ")");
  }

  std::vector<drivers::PathPoint> path(const std::string& field, std::string& path) const {
    if (path.empty()) source_.fail(field, "is missing: expected the name of a CSV file");
    path = relative_to(file_, path).string();
    try {
      return read_path(path);
    } catch (const LoadError& error) {
      // a file that is wrong tells so itself; one that cannot be read is an error of the field
      if (error.line() != 0) throw;
      source_.fail(field, error.what());
    }
  }

  void listeners() {
    std::map<std::string, int> addresses;
    for (int i = 0; i < config_.listen_size(); ++i) {
      const std::string field = item("listen", i);
      v1::Listen& listen = *config_.mutable_listen(i);
      std::string address;
      switch (listen.address_case()) {
        case v1::Listen::kUnix:
          address = unix_socket(field + ".unix", *listen.mutable_unix());
          break;
        case v1::Listen::kTcp:
          address = tcp(field + ".tcp", *listen.mutable_tcp());
          break;
        case v1::Listen::ADDRESS_NOT_SET:
          source_.fail(field, "has no address (permitted: unix, tcp)");
      }
      const auto [same, is_new] = addresses.emplace(address, i);
      if (!is_new) source_.fail(field, "has the same address as " + item("listen", same->second));
    }
  }

  std::string unix_socket(const std::string& field, v1::Listen::Unix& listen) const {
    if (listen.path().empty()) source_.fail(field + ".path", "is missing: expected the path of a socket");
    listen.set_path(relative_to(file_, listen.path()).string());
    check_socket_length(field + ".path", listen.path());
    for (int i = 0; i < listen.allow_size(); ++i) {
      const std::string allow = field + "." + item("allow", i);
      if (listen.allow(i).group().empty()) {
        source_.fail(allow + ".group", "is missing: expected the name of a group");
      }
      if (listen.allow(i).role() == v1::ROLE_UNSPECIFIED) {
        source_.fail(allow + ".role", "is missing (permitted: OBSERVE, SCRIPT, DRIVE, ADMIN)");
      }
    }
    return listen.path();
  }

  std::string tcp(const std::string& field, v1::Listen::Tcp& listen) const {
    in_addr four{};
    in6_addr six{};
    const bool is_four = ::inet_pton(AF_INET, listen.address().c_str(), &four) == 1;
    const bool is_six = !is_four && ::inet_pton(AF_INET6, listen.address().c_str(), &six) == 1;
    const bool is_encrypted = listen.has_tls();
    if (!is_four && !is_six) {
      source_.fail(field + ".address", in_quotes(listen.address()) + " is not an IP address" +
                                           (is_encrypted ? "" : " (permitted: 127.0.0.1, ::1)"));
    }
    if (is_encrypted) {
      tls(field, listen);
    } else if (listen.allow_size() > 0) {
      source_.fail(field + ".allow", "needs tls: only a certificate tells who a client over TCP is");
    } else if (is_four ? (ntohl(four.s_addr) >> 24U) != 127 : !IN6_IS_ADDR_LOOPBACK(&six)) {
      source_.fail(field + ".address", in_quotes(listen.address()) +
                                           " can be reached from other machines; TCP without TLS is for this"
                                           " one only (permitted: 127.0.0.1, ::1)");
    }
    check_range(source_, field + ".port", listen.port(), {1, 65535});
    return listen.address() + " " + std::to_string(listen.port());
  }

  void tls(const std::string& field, v1::Listen::Tcp& listen) const {
    v1::Listen::Tls& tls = *listen.mutable_tls();
    const std::pair<const char*, std::string*> files[] = {{"certificate", tls.mutable_certificate()},
                                                          {"key", tls.mutable_key()},
                                                          {"authority", tls.mutable_authority()}};
    for (const auto& [name, path] : files) {
      if (path->empty()) source_.fail(field + ".tls." + name, "is missing: expected the name of a PEM file");
      *path = relative_to(file_, *path).string();
    }
    if (listen.allow_size() == 0) {
      source_.fail(field,
                   "allows nobody: expected allow { name: ... role: ... } for each client's certificate");
    }
    for (int i = 0; i < listen.allow_size(); ++i) {
      const std::string allow = field + "." + item("allow", i);
      if (listen.allow(i).name().empty()) {
        source_.fail(allow + ".name", "is missing: expected the name in a client's certificate");
      }
      if (listen.allow(i).role() < v1::OBSERVE || listen.allow(i).role() > v1::ADMIN) {
        source_.fail(allow + ".role", "is missing (permitted: OBSERVE, SCRIPT, DRIVE, ADMIN)");
      }
    }
  }

  std::set<std::string> sockets_;                        // of external devices
  std::map<std::string, v1::Device::Fastrak> trackers_;  // the first station of each port
  std::set<std::string> stations_;                       // of all ports
  v1::DaemonConfig& config_;
  const TextSource& source_;
  const std::filesystem::path& file_;
};

}  // namespace

LoadedConfig load_config(const std::filesystem::path& file) {
  v1::DaemonConfig message;
  const TextSource source = read_message(file, message);
  return check_config(std::move(message), source, file);
}

LoadedConfig check_config(v1::DaemonConfig message, const TextSource& source,
                          const std::filesystem::path& file) {
  check_values(message, source);
  LoadedConfig loaded{std::move(message), {}, {}, {}, source};
  ConfigCheck(loaded.message, source, file).check(loaded);
  return loaded;
}

v1::Capacity default_capacity() {
  return check_config(v1::DaemonConfig(), TextSource(), std::filesystem::path()).message.capacity();
}

}  // namespace haptic::load
