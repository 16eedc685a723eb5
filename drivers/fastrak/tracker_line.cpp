#include "drivers/fastrak/tracker_line.h"

#include <algorithm>
#include <exception>
#include <map>
#include <thread>
#include <utility>

#include "drivers/device_error.h"
#include "rt/tick_clock.h"

namespace haptic::drivers::fastrak {

namespace {

constexpr std::chrono::milliseconds kStatusWait{500};

bool is_station(const Station& station, int number) { return station.number == number; }

}  // namespace

/// Waits until nobody uses the port, and uses it without the lock. A failure loses the port for all.
template <class Work>
void TrackerLine::use_port(Lock& lock, const Work& work) {
  in_use_ = true;
  lock.unlock();
  try {
    work();
  } catch (const std::exception& error) {
    lock.lock();
    in_use_ = false;
    loss_ = error.what();
    changed_.notify_all();
    throw;
  }
  lock.lock();
  in_use_ = false;
  changed_.notify_all();
}

void TrackerLine::join(const Station& station, const std::function<void()>& go_on) {
  Lock lock(mutex_);
  ++waiting_;
  changed_.wait(lock, [this] { return !in_use_; });
  --waiting_;
  if (loss_ && !stations_.empty()) {
    throw DeviceError(settings_.port + ": its other stations have just lost it");
  }
  loss_.reset();
  std::vector<Station> stations = stations_;
  stations.push_back(station);
  const bool is_first = stations_.empty();
  try {
    use_port(lock, [&] {
      if (is_first) {
        port_.emplace(settings_.port, settings_.baud);
        introduce(go_on);
      }
      start(stations);
    });
  } catch (const std::exception&) {
    if (is_first) port_.reset();
    throw;
  }
  if (is_first) parser_ = RecordParser(settings_.model);
  inbox_[static_cast<std::size_t>(station.number)].reset();
  stations_ = std::move(stations);
}

void TrackerLine::leave(int station) noexcept {
  Lock lock(mutex_);
  std::erase_if(stations_, [station](const Station& one) { return is_station(one, station); });
  if (!stations_.empty()) return;
  ++waiting_;
  changed_.wait(lock, [this] { return !in_use_; });
  --waiting_;
  // somebody may have joined meanwhile
  if (!stations_.empty() || !port_) return;
  try {
    if (!loss_) send(silence_command(settings_.model));
  } catch (const std::exception&) {
    // it is gone, and silent
  }
  port_.reset();
}

std::optional<Arrival> TrackerLine::receive(int station, std::chrono::milliseconds patience) {
  std::optional<Arrival>& inbox = inbox_[static_cast<std::size_t>(station)];
  Lock lock(mutex_);
  const auto is_free = [this] { return !in_use_ && waiting_ == 0; };
  if (!inbox && !is_free()) changed_.wait_for(lock, patience, [&] { return inbox || loss_ || is_free(); });
  if (loss_) throw DeviceError(*loss_);
  if (!inbox && is_free()) read(lock, patience);
  return std::exchange(inbox, std::nullopt);
}

void TrackerLine::read(Lock& lock, std::chrono::milliseconds patience) {
  std::array<std::uint8_t, 256> bytes{};
  std::size_t count = 0;
  use_port(lock, [&] { count = port_->read_some(bytes, patience); });
  const Nanoseconds now = rt::monotonic_ns();
  Record record;
  for (std::size_t i = 0; i < count; ++i) {
    if (parser_.take(bytes[i], record)) inbox_[static_cast<std::size_t>(record.station)] = {record, now};
  }
}

void TrackerLine::start_again() {
  Lock lock(mutex_);
  ++waiting_;
  changed_.wait(lock, [this] { return !in_use_; });
  --waiting_;
  if (loss_) throw DeviceError(*loss_);
  // another station may have done it just now
  if (std::chrono::steady_clock::now() - started_ < settings_.silence) return;
  const std::vector<Station> stations = stations_;
  use_port(lock, [&] { start(stations); });
}

void TrackerLine::introduce(const std::function<void()>& go_on) {
  // a port that is just being opened echoes: a tracker that sends hears itself, and may wait for the end of a
  // command that is none
  send("\r");
  send(silence_command(settings_.model));
  std::this_thread::sleep_for(settings_.settle);
  port_->drain(settings_.command);
  send(status_command(settings_.model));
  std::vector<std::uint8_t> answer;
  std::array<std::uint8_t, 64> bytes{};
  while (!is_status(settings_.model, answer)) {
    go_on();
    const std::size_t count = port_->read_some(bytes, kStatusWait);
    answer.insert(answer.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    constexpr std::size_t kMost = 1024;
    if (count > 0 && answer.size() < kMost) continue;
    throw DeviceError(settings_.port +
                      (answer.empty() ? ": nothing answers" : ": what answers is no such tracker") +
                      "; is its rate " + std::to_string(settings_.baud) + " baud?");
  }
}

void TrackerLine::start(const std::vector<Station>& stations) {
  for (const std::string& command : start_commands(settings_.model, stations)) {
    send(command);
    std::this_thread::sleep_for(settings_.command);
  }
  started_ = std::chrono::steady_clock::now();
}

void TrackerLine::send(const std::string& command) {
  port_->write({reinterpret_cast<const std::uint8_t*>(command.data()), command.size()});
}

std::shared_ptr<TrackerLine> line_on(const LineSettings& settings) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<TrackerLine>> lines;
  const std::lock_guard lock(mutex);
  std::weak_ptr<TrackerLine>& known = lines[settings.port];
  std::shared_ptr<TrackerLine> line = known.lock();
  if (!line) known = line = std::make_shared<TrackerLine>(settings);
  return line;
}

}  // namespace haptic::drivers::fastrak
