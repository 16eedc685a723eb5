#include "client/bridge/outbox.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace haptic::bridge {
namespace {

constexpr std::size_t kGapLimit = 16;  // apart from each other; a daemon that restarts begins a new one

std::uint64_t frames_of(const v1::Gap& gap) { return gap.last_sequence() - gap.first_sequence() + 1; }

// whether nothing is between the two
bool continues(const v1::Gap& gap, const v1::Gap& later) {
  return gap.subscription() == later.subscription() && gap.last_sequence() + 1 == later.first_sequence();
}

// `later` follows `gaps`
void append(std::vector<v1::Gap>& gaps, const v1::Gap& later) {
  if (gaps.empty() || !continues(gaps.back(), later)) {
    if (gaps.size() == kGapLimit) {
      gaps.erase(gaps.begin());
    }
    gaps.push_back(later);
    return;
  }
  v1::Gap& gap = gaps.back();
  gap.set_last_sequence(later.last_sequence());
  gap.set_last_tick(later.last_tick());
  for (const int topic : later.topic()) {
    if (std::find(gap.topic().begin(), gap.topic().end(), topic) == gap.topic().end()) {
      gap.add_topic(static_cast<v1::Topic>(topic));
    }
  }
}

// `earlier` comes before `gaps`
void prepend(std::vector<v1::Gap> earlier, std::vector<v1::Gap>& gaps) {
  for (const v1::Gap& gap : gaps) {
    append(earlier, gap);
  }
  gaps = std::move(earlier);
}

}  // namespace

Outbox::Outbox(const std::vector<Lane>& lanes, std::string gap_subject, std::size_t limit)
    : gap_subject_(std::move(gap_subject)), limit_(limit) {
  queues_.resize(lanes.size());
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    queues_[i].lane = lanes[i];
    queues_[i].flow.set_topic(lanes[i].topic);
  }
}

void Outbox::add(std::size_t lane, const v1::Frame& frame) {
  Waiting item;
  frame.SerializeToString(&item.payload);
  item.range.set_subscription(frame.subscription());
  item.range.set_first_sequence(frame.sequence());
  item.range.set_last_sequence(frame.sequence());
  item.range.set_first_tick(frame.tick());
  item.range.set_last_tick(frame.tick());
  {
    const std::lock_guard lock(mutex_);
    Queue& queue = queues_[lane];
    item.range.add_topic(queue.lane.topic);
    item.order = ++order_;
    while (!queue.waiting.empty() &&
           (queue.lane.keep == Keep::kLatest || queue.bytes + item.payload.size() > limit_)) {
      drop_oldest(queue);
    }
    item.before = std::exchange(queue.before_next, {});
    queue.bytes += item.payload.size();
    queue.waiting.push_back(std::move(item));
  }
  arrived_.notify_one();
}

void Outbox::add_gap(std::size_t lane, const v1::Gap& gap) {
  const std::lock_guard lock(mutex_);
  Queue& queue = queues_[lane];
  append(queue.before_next, gap);
  queue.flow.set_lost_before(queue.flow.lost_before() + frames_of(gap));
}

void Outbox::drop_oldest(Queue& queue) {
  Waiting oldest = std::move(queue.waiting.front());
  queue.waiting.pop_front();
  queue.bytes -= oldest.payload.size();
  queue.flow.set_lost(queue.flow.lost() + 1);
  append(oldest.before, oldest.range);
  prepend(std::move(oldest.before), queue.waiting.empty() ? queue.before_next : queue.waiting.front().before);
}

std::optional<Outgoing> Outbox::take(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  std::optional<Outgoing> message = next();
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!message && arrived_.wait_until(lock, deadline) == std::cv_status::no_timeout) {
    message = next();
  }
  return message;
}

std::optional<Outgoing> Outbox::next() {
  Queue* first = nullptr;
  for (Queue& queue : queues_) {
    if (!queue.waiting.empty() &&
        (first == nullptr || queue.waiting.front().order < first->waiting.front().order)) {
      first = &queue;
    }
  }
  if (first == nullptr) {
    return std::nullopt;
  }
  Outgoing message;
  message.lane = static_cast<std::size_t>(first - queues_.data());
  Waiting& item = first->waiting.front();
  if (!item.before.empty()) {
    message.is_gap = true;
    message.subject = gap_subject_;
    message.range = std::move(item.before.front());
    item.before.erase(item.before.begin());
    message.range.SerializeToString(&message.payload);
    return message;
  }
  message.subject = first->lane.subject;
  message.payload = std::move(item.payload);
  message.range = std::move(item.range);
  first->bytes -= message.payload.size();
  first->waiting.pop_front();
  return message;
}

void Outbox::published(const Outgoing& message) {
  if (message.is_gap) {
    return;
  }
  const std::lock_guard lock(mutex_);
  v1::BridgeStatus::Flow& flow = queues_[message.lane].flow;
  flow.set_published(flow.published() + 1);
  flow.set_bytes(flow.bytes() + message.payload.size());
}

void Outbox::failed(const Outgoing& message) {
  const std::lock_guard lock(mutex_);
  Queue& queue = queues_[message.lane];
  if (!message.is_gap) {
    queue.flow.set_lost(queue.flow.lost() + 1);
  }
  prepend({message.range}, queue.waiting.empty() ? queue.before_next : queue.waiting.front().before);
}

bool Outbox::is_empty() const {
  const std::lock_guard lock(mutex_);
  return std::all_of(queues_.begin(), queues_.end(),
                     [](const Queue& queue) { return queue.waiting.empty(); });
}

void Outbox::report(v1::BridgeStatus& status) const {
  const std::lock_guard lock(mutex_);
  status.clear_flow();
  for (const Queue& queue : queues_) {
    v1::BridgeStatus::Flow& flow = *status.add_flow();
    flow = queue.flow;
    flow.set_waiting(queue.waiting.size());
  }
}

}  // namespace haptic::bridge
