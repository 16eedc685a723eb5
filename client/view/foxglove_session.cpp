#include "client/view/foxglove_session.h"

#include <utility>

namespace haptic::gateway {

FoxgloveSession::FoxgloveSession(std::shared_ptr<WebSocket> socket, FoxgloveFeed& feed, std::string run)
    : socket_(std::move(socket)), feed_(feed), run_(std::move(run)) {}

FoxgloveSession::~FoxgloveSession() {
  if (is_listening_) {
    feed_.remove(*this);
  }
}

void FoxgloveSession::start(std::function<void()> on_end) {
  on_end_ = std::move(on_end);
  socket_->on_end([weak = weak_from_this()] {
    if (const auto self = weak.lock()) {
      self->end();
    }
  });
  viewer_.tell(foxglove_protocol::server_info("haptic-view " HAPTIC_VERSION, run_));
  viewer_.tell(foxglove_protocol::advertise(all_channels()));
  feed_.add(*this);
  is_listening_ = true;
  flush();
  read();
}

void FoxgloveSession::leave() { socket_->close(CloseCode::kGoingAway, "haptic-view stops"); }

void FoxgloveSession::read() {
  socket_->read([weak = weak_from_this()](std::string_view message, bool is_binary) {
    const auto self = weak.lock();
    if (!self) {
      return;
    }
    if (is_binary) {
      self->viewer_.take_bytes(message);
    } else {
      self->viewer_.take_text(message);
    }
    self->feed_.catch_up(self->viewer_);
    self->flush();
    self->read();
  });
}

void FoxgloveSession::flush() {
  if (writing_) {
    return;
  }
  auto next = viewer_.take();
  if (!next) {
    return;
  }
  writing_ = true;
  socket_->write(std::move(*next), [weak = weak_from_this()] {
    if (const auto self = weak.lock()) {
      self->writing_ = false;
      self->flush();
    }
  });
}

void FoxgloveSession::end() {
  if (std::exchange(is_listening_, false)) {
    feed_.remove(*this);
  }
  if (const auto on_end = std::exchange(on_end_, nullptr)) {
    on_end();
  }
}

}  // namespace haptic::gateway
