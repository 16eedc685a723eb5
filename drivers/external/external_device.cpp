#include "drivers/external/external_device.h"

#include <poll.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "drivers/external/external_protocol.h"
#include "drivers/external/external_socket.h"
#include "drivers/threaded_device.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::external {

namespace {

constexpr int kLookMs = 20;  // for a stop, silence, and who waits
// after each look: this thread goes before the servo's, and a program that never stops sending must not
constexpr timespec kBreath{0, 100'000};
constexpr std::size_t kLongestMessage = 256;  // what is longer is cut, and still too long
constexpr int kMostAtOnce = 16;               // messages before others are looked at

Nanoseconds nanoseconds(std::chrono::milliseconds time) { return std::chrono::nanoseconds(time).count(); }

class ExternalRoutine final : public DeviceRoutine {
 public:
  explicit ExternalRoutine(ExternalSettings settings) : settings_(std::move(settings)) {}

  void prepare() override {
    users_ = permitted_users(settings_.users);
    listener_.emplace(settings_.path, !settings_.users.empty());
  }

  void open() override {}

  void run(DeviceLink& link, const StopFlag& stop) override {
    wait_for_program("");
    while (!stop.is_raised()) {
      std::array<pollfd, 2> ready{pollfd{listener_->get(), POLLIN, 0}, pollfd{peer_.get(), POLLIN, 0}};
      // a program that must wait a little stays in the listener's queue
      if (is_closed()) ready[0].fd = -1;
      ::poll(ready.data(), ready.size(), kLookMs);
      if (ready[1].revents != 0) converse(link);
      if (ready[0].revents != 0 && !is_closed()) admit();
      if (ready[0].revents != 0 || ready[1].revents != 0) ::nanosleep(&kBreath, nullptr);
      if (peer_ && rt::monotonic_ns() - last_heard_ > nanoseconds(kSilence)) refuse(link, HAPTIC_SILENT);
    }
    if (peer_) refuse(link, HAPTIC_STOPPED);
  }

  void close() noexcept override { peer_ = Descriptor(); }

  void release() noexcept override { listener_.reset(); }

 private:
  bool is_closed() const noexcept { return !peer_ && rt::monotonic_ns() < open_from_; }

  void admit() {
    Descriptor newcomer = listener_->accept();
    if (!newcomer) return;
    uid_t user = 0;
    if (!user_of(newcomer, user) || std::find(users_.begin(), users_.end(), user) == users_.end()) {
      tell(newcomer, write_refusal(HAPTIC_NOT_PERMITTED));
      return;
    }
    if (peer_) {
      tell(newcomer, write_refusal(HAPTIC_BUSY));
      return;
    }
    peer_ = std::move(newcomer);
    life().tell(DevicePhase::kOpening, "the program that serves it has sent no sample yet");
    conversation_ = {};
    last_heard_ = rt::monotonic_ns();
  }

  void converse(DeviceLink& link) {
    for (int i = 0; i < kMostAtOnce && peer_; ++i) {
      std::array<std::byte, kLongestMessage> buffer{};
      std::size_t size = 0;
      switch (receive(peer_, buffer, size)) {
        case Reception::kNothing:
          return;
        case Reception::kEnded:
          forget(link, "the program that served it has ended the connection; ");
          return;
        case Reception::kMessage:
          take(link, std::span(buffer).first(std::min(size, buffer.size())));
      }
    }
  }

  void take(DeviceLink& link, std::span<const std::byte> message) {
    const Nanoseconds now = rt::monotonic_ns();
    const auto read = read_sample(message, now, conversation_);
    if (const haptic_refusal* const refusal = std::get_if<haptic_refusal>(&read)) {
      refuse(link, *refusal);
      return;
    }
    last_heard_ = now;
    link.publish(std::get<DeviceSample>(read));
    tell(peer_, write_force(link.live_force(now), conversation_.last_sequence, now));
  }

  void refuse(DeviceLink& link, haptic_refusal refusal) {
    tell(peer_, write_refusal(refusal));
    forget(link, refusal == HAPTIC_SILENT    ? "the program that served it fell silent; "
                 : refusal == HAPTIC_STOPPED ? ""
                                             : "the program that served it was cut off: it sent what is no "
                                               "message of this protocol; ");
  }

  void forget(DeviceLink& link, const std::string& why) {
    link.publish_nothing();
    peer_ = Descriptor();
    open_from_ = rt::monotonic_ns() + nanoseconds(kPause);
    wait_for_program(why);
  }

  void wait_for_program(const std::string& why) {
    std::string reason = why + "no program serves it at " + settings_.path;
    if (life().state().phase == DevicePhase::kReady && !stop_requested()) {
      life().lose(DevicePhase::kAbsent, std::move(reason));
    } else {
      life().tell(DevicePhase::kAbsent, std::move(reason));
    }
  }

  static void tell(const Descriptor& peer, const haptic_force& message) noexcept {
    send(peer, std::as_bytes(std::span(&message, 1)));
  }

  ExternalSettings settings_;
  std::vector<uid_t> users_;
  std::optional<ListenSocket> listener_;
  // the device's own thread's, while it runs
  Descriptor peer_;
  Conversation conversation_;
  Nanoseconds last_heard_ = 0;
  Nanoseconds open_from_ = 0;
};

}  // namespace

std::unique_ptr<Device> make_external(const ExternalSettings& settings) {
  return std::make_unique<ThreadedDevice>(
      DeviceInfo{.name = settings.name, .driver = "external", .max_force = settings.max_force},
      settings.world_from_base, std::make_unique<ExternalRoutine>(settings));
}

}  // namespace haptic::drivers::external
