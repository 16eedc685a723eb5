#include "ipc/outbox.h"

#include <utility>

#include "haptic/v1/control.pb.h"
#include "ipc/encode.h"
#include "proto/framing.h"

namespace haptic::ipc {
namespace {

void append_gap(std::uint32_t subscription, std::uint64_t first, std::uint64_t last, std::string& out) {
  v1::Envelope envelope;
  envelope.mutable_gap()->set_subscription(subscription);
  envelope.mutable_gap()->set_first_sequence(first);
  envelope.mutable_gap()->set_last_sequence(last);
  proto::append_frame(envelope, out);
}

}  // namespace

bool Outbox::push_control(std::string message) {
  if (control_bytes_ + message.size() > limits_.control_bytes) {
    return false;
  }
  control_bytes_ += message.size();
  control_.push_back(std::move(message));
  return true;
}

void Outbox::push_frame(std::uint32_t subscription, std::uint64_t sequence, SharedBytes body) {
  while (!data_.empty() &&
         (data_.size() >= limits_.data_frames || data_bytes_ + body->size() > limits_.data_bytes)) {
    drop_oldest();
  }
  data_bytes_ += body->size();
  data_.push_back({subscription, sequence, std::move(body)});
}

void Outbox::forget(std::uint32_t subscription) {
  std::erase_if(data_, [&](const Waiting& frame) {
    if (frame.subscription != subscription) {
      return false;
    }
    data_bytes_ -= frame.body->size();
    return true;
  });
  last_sent_.erase(subscription);
}

void Outbox::clear() {
  control_.clear();
  control_bytes_ = 0;
  data_.clear();
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
  while (!data_.empty() && taken < bytes) {
    Waiting& frame = data_.front();
    Piece piece;
    std::uint64_t& last = last_sent_[frame.subscription];
    if (frame.sequence > last + 1) {
      append_gap(frame.subscription, last + 1, frame.sequence - 1, piece.own);
    }
    last = frame.sequence;
    append_frame_head(frame.sequence, frame.subscription, frame.body->size(), piece.own);
    taken += piece.own.size() + frame.body->size();
    data_bytes_ -= frame.body->size();
    piece.shared = std::move(frame.body);
    pieces.push_back(std::move(piece));
    data_.pop_front();
  }
  return pieces;
}

void Outbox::drop_oldest() {
  data_bytes_ -= data_.front().body->size();
  data_.pop_front();
}

}  // namespace haptic::ipc
