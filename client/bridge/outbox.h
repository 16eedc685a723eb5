#pragma once
// What waits between the daemon and the broker: one bounded lane for each topic. The daemon's side never
// waits here: where a lane is full the oldest frame goes, and a Gap that comes before the next frame tells of
// it.
//
//     add(frame) -->  lane "objects"  [ . . . ]
//     add(frame) -->  lane "hips"     [ . ]       --> take(): in the order of arrival, a gap before what
//     follows it
//
// Safe to use from several threads.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "haptic/v1/bridge.pb.h"
#include "haptic/v1/control.pb.h"

namespace haptic::bridge {

enum class Keep {
  kLatest,  // a newer frame takes the place of one that waits
  kAll,     // frames wait, up to the limit of bytes
};

struct Lane {
  std::string subject;
  v1::Topic topic = v1::TOPIC_UNSPECIFIED;
  Keep keep = Keep::kLatest;
};

/// A message on its way. Tell the outbox what became of it.
struct Outgoing {
  std::string subject;
  std::string payload;
  bool is_gap = false;
  std::size_t lane = 0;
  v1::Gap range;  // the frame alone, or what the gap tells
};

class Outbox {
 public:
  /// `limit`: bytes of frames in each lane that keeps all.
  Outbox(const std::vector<Lane>& lanes, std::string gap_subject, std::size_t limit);

  /// Takes a frame as the daemon sent it.
  void add(std::size_t lane, const v1::Frame& frame);
  /// Takes what the daemon told of lost frames.
  void add_gap(std::size_t lane, const v1::Gap& gap);

  /// The next message, or nothing if none came in time.
  std::optional<Outgoing> take(std::chrono::milliseconds timeout);
  void published(const Outgoing& message);
  /// It did not get out: a gap will tell of it.
  void failed(const Outgoing& message);

  bool is_empty() const;
  /// Fills in flow.
  void report(v1::BridgeStatus& status) const;

 private:
  struct Waiting {
    std::uint64_t order = 0;
    std::string payload;
    v1::Gap range;
    std::vector<v1::Gap> before;  // to be told before it
  };
  struct Queue {
    Lane lane;
    std::deque<Waiting> waiting;
    std::size_t bytes = 0;
    std::vector<v1::Gap> before_next;  // to be told before what comes after all that waits
    v1::BridgeStatus::Flow flow;
  };

  static void drop_oldest(Queue& queue);
  std::optional<Outgoing> next();

  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Queue> queues_;
  std::string gap_subject_;
  std::size_t limit_;
  std::uint64_t order_ = 0;
};

}  // namespace haptic::bridge
