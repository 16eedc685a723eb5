#include "client/view/browser_session.h"

#include <utility>

#include "client/view/policy.h"

namespace haptic::gateway {

BrowserSession::BrowserSession(std::shared_ptr<WebSocket> socket, Rights rights,
                               std::shared_ptr<DaemonLink> link, double frames_per_second, Log& log)
    : socket_(std::move(socket)),
      rights_(rights),
      link_(std::move(link)),
      frames_per_second_(frames_per_second),
      log_(log) {}

void BrowserSession::start(std::function<void()> on_end) {
  on_end_ = std::move(on_end);
  socket_->on_end([weak = weak_from_this()] {
    if (const auto self = weak.lock()) {
      self->end();
    }
  });
  link_->open(
      [weak = weak_from_this()](const DaemonLink::Greeting& greeting) {
        if (const auto self = weak.lock()) {
          self->greet(greeting);
        }
      },
      [weak = weak_from_this()](const std::string& why) {
        if (const auto self = weak.lock()) {
          self->log_.tell_seldom("a page is closed: " + why);
          self->socket_->close(CloseCode::kTryAgainLater, why);
        }
      });
}

void BrowserSession::leave() { socket_->close(CloseCode::kGoingAway, "haptic-view stops"); }

void BrowserSession::greet(const DaemonLink::Greeting& greeting) {
  least_decimation_ = least_decimation(greeting.rate_hz, frames_per_second_);
  v1::Envelope envelope;
  *envelope.mutable_hello() = hello_for(rights_, greeting.hello);
  send(envelope.SerializeAsString(), [this] { read_daemon(); });
  read_page();
}

// what the socket and the link call back is this session's, which is there as long as they have not ended

void BrowserSession::read_daemon() {
  link_->read([weak = weak_from_this()](std::string_view message) {
    if (const auto self = weak.lock()) {
      self->send(std::string(message), [raw = self.get()] { raw->read_daemon(); });
    }
  });
}

void BrowserSession::read_page() {
  socket_->read([weak = weak_from_this()](std::string_view message, bool is_binary) {
    const auto self = weak.lock();
    if (!self || self->ended_) {
      return;
    }
    if (is_binary) {
      self->take_request(message);
    } else {
      self->socket_->close(CloseCode::kUnknownData, "haptic.v1 has binary messages only");
    }
  });
}

void BrowserSession::take_request(std::string_view message) {
  v1::Envelope envelope;
  if (!envelope.ParseFromArray(message.data(), static_cast<int>(message.size()))) {
    socket_->close(CloseCode::kBadPayload, "a message cannot be read as an envelope");
    return;
  }
  if (envelope.body_case() == v1::Envelope::BODY_NOT_SET) {
    read_page();  // from a newer page
    return;
  }
  if (!envelope.has_request()) {
    socket_->close(CloseCode::kProtocolError, "a page sends requests only");
    return;
  }
  v1::Request& request = *envelope.mutable_request();
  if (const auto error = judge(request, rights_, least_decimation_)) {
    refuse(request, *error);
    return;
  }
  link_->send(envelope, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) {
      self->read_page();
    }
  });
}

void BrowserSession::refuse(const v1::Request& request, const v1::Error& error) {
  v1::Envelope envelope;
  envelope.mutable_response()->set_id(request.id());
  *envelope.mutable_response()->mutable_error() = error;
  send(envelope.SerializeAsString(), [this] { read_page(); });
}

void BrowserSession::send(std::string envelope, std::function<void()> on_written) {
  pending_.push_back({{"", std::make_shared<const std::string>(std::move(envelope))}, std::move(on_written)});
  if (pending_.size() == 1) {
    write();
  }
}

void BrowserSession::write() {
  socket_->write(pending_.front().message, [weak = weak_from_this()] {
    const auto self = weak.lock();
    if (!self || self->ended_) {
      return;
    }
    const auto on_written = std::move(self->pending_.front().on_written);
    self->pending_.pop_front();
    if (!self->pending_.empty()) {
      self->write();
    }
    on_written();
  });
}

void BrowserSession::end() {
  if (ended_) {
    return;
  }
  ended_ = true;
  link_->close();
  if (const auto on_end = std::exchange(on_end_, nullptr)) {
    on_end();
  }
}

}  // namespace haptic::gateway
