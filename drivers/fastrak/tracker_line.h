#pragma once
// The serial port of one tracker, which the devices that are its stations share. Each has a thread of its
// own; one of them at a time uses the port, and hands every record to the station that it is of.
//
//     station 1's thread --receive()--+                      +--> inbox 1 --> station 1's thread
//     station 2's thread --receive()--+--> one of them reads +--> inbox 2 --> station 2's thread
//
// Where the port is lost, all who share it learn of it, and it is opened again when all have left. Not
// real-time safe.

#include <array>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "drivers/device.h"
#include "drivers/fastrak/fastrak_protocol.h"
#include "drivers/io/serial/serial_port.h"

namespace haptic::drivers::fastrak {

struct LineSettings {
  std::string port;  // e.g. "/dev/ttyUSB0"
  unsigned baud = 115200;
  Model model = Model::kFastrak;
  std::chrono::milliseconds settle{2000};   // after it was told to be silent
  std::chrono::milliseconds command{50};    // after each command
  std::chrono::milliseconds silence{1500};  // in which a tracker that was just started is not started again
};

/// A record, and when it came.
struct Arrival {
  Record record;
  Nanoseconds time = 0;
};

class TrackerLine {
 public:
  explicit TrackerLine(LineSettings settings) : settings_(std::move(settings)) {}

  TrackerLine(const TrackerLine&) = delete;
  TrackerLine& operator=(const TrackerLine&) = delete;

  /// From now on there are records of this station. The first to join opens the port and asks what is there;
  /// `go_on` is called meanwhile, and throws if that shall end. Throws DeviceError, and has not joined then.
  void join(const Station& station, const std::function<void()>& go_on);

  /// No records of it any more. The last to leave tells the tracker to be silent and closes the port.
  void leave(int station) noexcept;

  /// The newest record of the station since the last call; nothing if none comes within `patience`. Throws
  /// DeviceError if the port is lost.
  std::optional<Arrival> receive(int station, std::chrono::milliseconds patience);

  /// The tracker fell silent, and may have been switched off: it is told anew what to send. Throws
  /// DeviceError.
  void start_again();

 private:
  using Lock = std::unique_lock<std::mutex>;
  template <class Work>
  void use_port(Lock& lock, const Work& work);
  void introduce(const std::function<void()>& go_on);
  void start(const std::vector<Station>& stations);
  void send(const std::string& command);
  void read(Lock& lock, std::chrono::milliseconds patience);

  LineSettings settings_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool in_use_ = false;              // the port, by one of the threads; port_ is its alone meanwhile
  int waiting_ = 0;                  // threads that want to do more with it than read
  std::optional<std::string> loss_;  // why the port is lost
  std::optional<io::SerialPort> port_;
  RecordParser parser_;
  std::vector<Station> stations_;  // that have joined
  std::array<std::optional<Arrival>, kMostStations + 1> inbox_;
  std::chrono::steady_clock::time_point started_{};
};

/// The line of this port: the same one for all who ask while somebody has it.
std::shared_ptr<TrackerLine> line_on(const LineSettings& settings);

}  // namespace haptic::drivers::fastrak
