#include "ipc/outbox.h"

#include <utility>

#include "haptic/v1/control.pb.h"
#include "proto/framing.h"

namespace haptic::ipc {
namespace {

// enough that heads and system calls count little, little enough that a client can hold one
constexpr std::size_t kBatchFrames = 64;
constexpr std::size_t kBatchBytes = std::size_t{64} * 1024;  // one frame may be larger, then it is alone

void append_gap(const OutgoingFrame& next, std::uint64_t last_sent, std::string& out) {
  v1::Envelope envelope;
  v1::Gap& gap = *envelope.mutable_gap();
  gap.set_subscription(next.subscription);
  gap.set_first_sequence(last_sent + 1);
  gap.set_last_sequence(next.sequence - 1);
  for (int topic = v1::Topic_MIN; topic <= v1::Topic_MAX; ++topic) {
    if ((next.lost_before.topics & topic_bit(static_cast<v1::Topic>(topic))) != 0) {
      gap.add_topic(static_cast<v1::Topic>(topic));
    }
  }
  gap.set_first_tick(next.lost_before.first_tick);
  gap.set_last_tick(next.lost_before.last_tick);
  proto::append_frame(envelope, out);
}

}  // namespace

void Loss::add(const Loss& later) noexcept {
  if (later.topics == 0) {
    return;
  }
  first_tick = topics == 0 ? later.first_tick : first_tick;
  last_tick = later.last_tick;
  topics |= later.topics;
}

bool Outbox::push_control(std::string message) {
  if (control_bytes_ + message.size() > limits_.control_bytes) {
    return false;
  }
  control_bytes_ += message.size();
  control_.push_back(std::move(message));
  return true;
}

void Outbox::push_frame(OutgoingFrame frame) {
  Queue& queue = queues_[frame.subscription];
  while (frame.delivery == v1::LATEST && !queue.frames.empty()) {
    drop_front(queue);
  }
  while (data_frames_ > 0 &&
         (data_frames_ >= limits_.data_frames || data_bytes_ + frame.body->size() > limits_.data_bytes)) {
    drop_front(*oldest());
  }
  if (queue.frames.empty()) {
    Loss lost = std::exchange(queue.lost, {});
    lost.add(frame.lost_before);
    frame.lost_before = lost;
  }
  ++data_frames_;
  data_bytes_ += frame.body->size();
  queue.frames.push_back({++arrivals_, std::move(frame)});
}

void Outbox::forget(std::uint32_t subscription) {
  const auto found = queues_.find(subscription);
  if (found == queues_.end()) {
    return;
  }
  while (!found->second.frames.empty()) {
    drop_front(found->second);
  }
  queues_.erase(found);
}

void Outbox::clear() {
  control_.clear();
  control_bytes_ = 0;
  queues_.clear();
  data_frames_ = 0;
  data_bytes_ = 0;
}

std::vector<Piece> Outbox::take(std::size_t bytes) {
  std::vector<Piece> pieces;
  std::size_t taken = 0;
  while (!control_.empty() && taken < bytes) {
    taken += control_.front().size();
    control_bytes_ -= control_.front().size();
    pieces.push_back({std::move(control_.front()), nullptr});
    control_.pop_front();
  }
  while (data_frames_ > 0 && taken < bytes) {
    taken += take_frames(*oldest(), pieces);
  }
  return pieces;
}

// the queue whose first frame has waited longest; there must be a frame
Outbox::Queue* Outbox::oldest() {
  Queue* found = nullptr;
  for (auto& [subscription, queue] : queues_) {
    if (!queue.frames.empty() &&
        (found == nullptr || queue.frames.front().arrival < found->frames.front().arrival)) {
      found = &queue;
    }
  }
  return found;
}

void Outbox::drop_front(Queue& queue) {
  const OutgoingFrame frame = std::move(queue.frames.front().frame);
  queue.frames.pop_front();
  --data_frames_;
  data_bytes_ -= frame.body->size();
  Loss lost = frame.lost_before;
  lost.add({frame.topics, frame.tick, frame.tick});
  if (queue.frames.empty()) {
    queue.lost.add(lost);
    return;
  }
  Loss& next = queue.frames.front().frame.lost_before;
  lost.add(next);
  next = lost;
}

// one frame, or a batch if the client takes that; returns the bytes
std::size_t Outbox::take_frames(Queue& queue, std::vector<Piece>& pieces) {
  std::vector<FrameHead> heads;
  const std::size_t first = pieces.size();
  std::string gap;
  std::size_t taken = 0;
  do {
    OutgoingFrame& frame = queue.frames.front().frame;
    if (frame.sequence > queue.last_sent + 1) {
      append_gap(frame, queue.last_sent, gap);
    }
    queue.last_sent = frame.sequence;
    heads.push_back({frame.sequence, frame.subscription, frame.body->size()});
    taken += frame.body->size();
    data_bytes_ -= frame.body->size();
    --data_frames_;
    pieces.push_back({{}, std::move(frame.body)});
    const bool may_batch = frame.delivery == v1::LOSSLESS;
    queue.frames.pop_front();
    if (!may_batch || heads.size() == kBatchFrames || queue.frames.empty()) {
      break;
    }
    const OutgoingFrame& next = queue.frames.front().frame;
    if (next.sequence != queue.last_sent + 1 || taken + next.body->size() > kBatchBytes) {
      break;
    }
  } while (true);

  pieces[first].own = std::move(gap);
  if (heads.size() == 1) {
    append_frame_head(heads[0].sequence, heads[0].subscription, heads[0].body_size, pieces[first].own);
  } else {
    const std::vector<std::string> own = batch_heads(heads);
    for (std::size_t i = 0; i < own.size(); ++i) {
      pieces[first + i].own += own[i];
    }
  }
  for (std::size_t i = first; i < pieces.size(); ++i) {
    taken += pieces[i].own.size();
  }
  return taken;
}

}  // namespace haptic::ipc
