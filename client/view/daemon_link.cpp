#include "client/view/daemon_link.h"

#include <utility>

namespace haptic::gateway {
namespace {

constexpr std::chrono::milliseconds kConnectLimit{3'000};
constexpr std::chrono::milliseconds kGreetingLimit{3'000};

v1::Envelope our_hello() {
  v1::Envelope envelope;
  v1::Hello& hello = *envelope.mutable_hello();
  hello.set_major(proto::kProtocolMajor);
  hello.set_minor(proto::kProtocolMinor);
  for (const std::string_view feature : proto::kFeatures) {
    hello.add_feature(std::string(feature));
  }
  hello.set_program("haptic-view");
  hello.set_version(HAPTIC_VERSION);
  return envelope;
}

v1::Envelope status_request() {
  v1::Envelope envelope;
  envelope.mutable_request()->set_id(1);
  envelope.mutable_request()->mutable_get_status();
  return envelope;
}

}  // namespace

DaemonLink::DaemonLink(boost::asio::io_context& io, const DaemonDoor& door)
    : io_(io), door_(door), timer_(io) {}

void DaemonLink::open(OnOpen on_open, OnEnd on_end) {
  on_open_ = std::move(on_open);
  on_end_ = std::move(on_end);
  door_.connect(io_, kConnectLimit,
                [self = shared_from_this()](std::shared_ptr<ByteStream> stream, const std::string& problem) {
                  if (self->ended_) {
                    return;
                  }
                  if (stream) {
                    self->greet(std::move(stream));
                  } else {
                    self->end("cannot reach the daemon at " + self->door_.name() + ": " + problem);
                  }
                });
}

void DaemonLink::greet(std::shared_ptr<ByteStream> stream) {
  stream_ = std::move(stream);
  timer_.expires_after(kGreetingLimit);
  timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (!error) {
      self->end("what listens at " + self->door_.name() + " did not say hello in time");
    }
  });
  send(our_hello());
  read([this](std::string_view message) { take_greeting(message, {}); });
}

// the hello, then the status
void DaemonLink::take_greeting(std::string_view message, Greeting greeting) {
  v1::Envelope envelope;
  if (!envelope.ParseFromArray(message.data(), static_cast<int>(message.size()))) {
    end("what listens at " + door_.name() + " is not a hapticd: a message cannot be read");
    return;
  }
  if (envelope.has_goodbye()) {
    end("the daemon says: " + envelope.goodbye().error().message());
    return;
  }
  const bool expects_hello = greeting.hello.major() == 0;
  if (expects_hello && envelope.hello().major() != proto::kProtocolMajor) {
    end(!envelope.has_hello()
            ? "what listens at " + door_.name() + " is not a hapticd"
            : "the daemon speaks protocol " + std::to_string(envelope.hello().major()) + ", haptic-view " +
                  std::to_string(proto::kProtocolMajor) + "; install matching versions");
    return;
  }
  if (expects_hello) {
    greeting.hello = envelope.hello();
    send(status_request());
  } else if (envelope.response().id() == 1) {
    greeting.rate_hz = envelope.response().status().rate_hz();
    timer_.cancel();
    std::exchange(on_open_, nullptr)(greeting);
    return;
  }
  // an event may come between
  read([this, greeting = std::move(greeting)](std::string_view next) { take_greeting(next, greeting); });
}

void DaemonLink::read(OnMessage on_message) {
  on_message_ = std::move(on_message);
  if (!fetching_ && !delivering_ && !ended_) {
    deliver();
  }
}

// in a loop, since a reader may ask again at once
void DaemonLink::deliver() {
  const auto self = shared_from_this();
  delivering_ = true;
  try {
    while (!ended_ && on_message_) {
      const auto message = reader_.next();
      if (!message) {
        fetch();
        break;
      }
      std::exchange(on_message_, nullptr)(*message);
    }
  } catch (const proto::FramingError& error) {
    end("what listens at " + door_.name() + " is not a hapticd: " + error.what());
  }
  delivering_ = false;
}

void DaemonLink::fetch() {
  fetching_ = true;
  stream_->read_some(boost::asio::buffer(chunk_),
                     [self = shared_from_this()](const boost::system::error_code& error, std::size_t size) {
                       self->fetching_ = false;
                       if (self->ended_) {
                         return;
                       }
                       if (error) {
                         self->end("the daemon at " + self->door_.name() + " closed the connection");
                         return;
                       }
                       self->reader_.append(std::string_view(self->chunk_.data(), size));
                       self->deliver();
                     });
}

void DaemonLink::send(const v1::Envelope& envelope, OnSent on_sent) {
  if (ended_) {
    return;
  }
  Outbound& next = outbound_.emplace_back();
  proto::append_frame(envelope, next.bytes);
  next.on_sent = std::move(on_sent);
  if (outbound_.size() == 1) {
    write();
  }
}

void DaemonLink::write() {
  stream_->write(boost::asio::buffer(outbound_.front().bytes),
                 [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                   if (self->ended_ || error) {
                     return;  // reading tells of the end, and why
                   }
                   const OnSent on_sent = std::move(self->outbound_.front().on_sent);
                   self->outbound_.pop_front();
                   if (!self->outbound_.empty()) {
                     self->write();
                   }
                   if (on_sent) {
                     on_sent();
                   }
                 });
}

void DaemonLink::close() {
  ended_ = true;
  on_open_ = nullptr;
  on_end_ = nullptr;
  on_message_ = nullptr;
  timer_.cancel();
  if (stream_) {
    stream_->close();
  }
}

void DaemonLink::end(const std::string& why) {
  if (ended_) {
    return;
  }
  const OnEnd on_end = std::move(on_end_);
  close();
  if (on_end) {
    on_end(why);
  }
}

}  // namespace haptic::gateway
