#pragma once
// Keeps the last ticks at full rate, and when a fault is latched writes what came before it and 0.1 s more:
//
//     publisher --frames--> tape        fault --> 0.1 s --> a thread writes the file --> FAULT_RECORDED
//     servo    --a state each second--> tape
//
// It subscribes as a client does, and each second asks the servo thread for a copy of its state, where a
// replay can start. One file at a time: a fault that comes within the 0.1 s is in the file of the one before,
// one that comes while the file is written gets none. io thread, which never waits for a file; in the end the
// destructor does.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "flight/excerpt.h"
#include "flight/tape.h"
#include "ipc/publisher.h"
#include "ipc/services.h"
#include "ipc/servo_link.h"

namespace haptic::ipc {

struct FlightSettings {
  std::string directory;                       // empty: there is no recorder
  double seconds = 2.0;                        // before a fault
  std::uint32_t keep = 20;                     // recordings
  std::size_t bytes = std::size_t{64} << 20U;  // that are reserved
};

/// What is kept of a scene, so that it fits into the memory there is.
struct FlightPlan {
  TopicSet topics = 0;       // of each tick, beside events
  bool keeps_states = true;  // so that it can be replayed
  double seconds = 0.0;      // before a fault, as far as can be told beforehand
  std::size_t bytes = 0;     // of the memory that are used
};

/// All topics, or without the HIPs, or without the objects, too: a replay computes them again. `devices` is
/// how many there are.
FlightPlan plan_flight(const FlightSettings& settings, double rate_hz, std::size_t devices,
                       const engine::Scene& scene);

class FlightRecorder {
 public:
  using ReportDevices = std::function<v1::DeviceList()>;
  /// `faults` as given to begin(); `path` is where they are recorded, and empty if they are not.
  using OnWritten = std::function<void(const std::vector<std::uint64_t>& faults, const std::string& path)>;

  /// All of it outlives this.
  FlightRecorder(const FlightSettings& settings, const Services& services, Publisher& publisher,
                 ServoLink& servo, ReportDevices report_devices, OnWritten on_written);
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// A scene that runs from this tick on.
  void learn(const v1::SceneDescription& scene, std::shared_ptr<const engine::Scene> built,
             std::uint64_t from_tick);

  /// A fault has been latched; `number` is what on_written() tells.
  void begin(const v1::Fault& fault, std::uint64_t number, SteadyClock::time_point now);

  /// To be called every few milliseconds.
  void poll(SteadyClock::time_point now);

  /// Nothing follows: what waits for its 0.1 s is written now.
  void finish();

 private:
  struct Waiting {
    v1::Fault first;
    std::vector<std::uint64_t> faults;
    std::uint64_t until_tick = 0;
    SteadyClock::time_point deadline{};  // even if ticks do not come
    std::uint64_t realtime_ns = 0;
  };

  void subscribe();
  void take(const OutgoingFrame& frame);
  void keep(flight::Entry entry, std::string_view bytes);
  void forget();
  void ask_for_state(SteadyClock::time_point now);
  void hasten_state();
  void write();
  void collect();

  FlightSettings settings_;
  const Services& services_;
  Publisher& publisher_;
  ServoLink& servo_;
  ReportDevices report_devices_;
  OnWritten on_written_;

  flight::Tape tape_;
  FlightPlan plan_;
  std::deque<flight::KeptScene> scenes_;  // the oldest first
  std::shared_ptr<const engine::Scene> running_;
  std::uint32_t subscription_ = 0;
  std::uint64_t sequence_ = 0;  // of the last frame
  std::uint64_t tick_ = 0;      // likewise
  std::uint64_t not_kept_ = 0;  // entries, as others were held

  bool asks_ = false;  // a state is on its way
  SteadyClock::time_point last_state_{};
  SteadyClock::time_point next_state_{};  // when to ask for the next one
  std::unique_ptr<Waiting> waiting_;
  std::vector<std::uint64_t> written_faults_;  // of the file at hand
  std::future<std::string> writing_;           // its path; joined before the tape goes
};

}  // namespace haptic::ipc
