#include "client/lib/connection.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "client/lib/error.h"

namespace haptic::client {
namespace {

constexpr std::size_t kChunk = std::size_t{64} * 1024;

constexpr std::uint64_t kHeartbeat = std::numeric_limits<std::uint64_t>::max();  // the id of all of them
constexpr int kBeatsInSilence = 4;                                               // of these some may be late

std::string seconds(std::chrono::milliseconds time) {
  const std::string whole = std::to_string(time.count() / 1000);
  const std::string tenths = std::to_string(time.count() / 100 % 10);
  return whole + (tenths == "0" ? "" : "." + tenths) + " s";
}

// a daemon that merely ends, or ends this client, is gone; a mismatch or a refusal is more than that
[[noreturn]] void throw_goodbye(const v1::Error& error) {
  if (error.code() == v1::Error::FAILED) {
    throw Unreachable(error.message());
  }
  throw_error(error);
}

}  // namespace

Connection::Connection(const Options& options)
    : name_(to_string(parse_address(options.address))),
      timeout_(options.timeout),
      socket_(StreamSocket::connect(parse_address(options.address), Clock::now() + options.timeout)),
      chunk_(kChunk) {
  const Address address = parse_address(options.address);
  if (address.path.empty() && !options.identity.empty()) {
    tls_.emplace(options.identity, address.host);
    tls_->handshake(socket_, Clock::now() + options.timeout);
  }
  greet(options, Clock::now() + options.timeout);
}

void Connection::greet(const Options& options, Clock::time_point deadline) {
  v1::Envelope mine;
  v1::Hello& hello = *mine.mutable_hello();
  hello.set_major(options.major);
  hello.set_minor(proto::kProtocolMinor);
  for (const std::string_view feature : proto::kFeatures) {
    hello.add_feature(std::string(feature));
  }
  hello.set_program(options.program);
  hello.set_version(options.version);
  send(mine, deadline);

  std::optional<v1::Envelope> theirs = read(deadline, false);
  if (!theirs) {
    throw Unreachable("what listens at " + name_ + " did not say hello within " + seconds(options.timeout));
  }
  if (!theirs->has_hello()) {
    throw Unreachable("what listens at " + name_ + " is not a hapticd: it did not begin with hello");
  }
  daemon_ = std::move(*theirs->mutable_hello());
  if (daemon_.major() != options.major) {
    v1::Error error;
    error.set_code(v1::Error::MISMATCH);
    error.set_message("this program speaks protocol " + std::to_string(options.major) + "." +
                      std::to_string(proto::kProtocolMinor) + ", the daemon (" + daemon_.program() + " " +
                      daemon_.version() + ") " + std::to_string(daemon_.major()) + "." +
                      std::to_string(daemon_.minor()) + "; install matching versions");
    throw ProtocolMismatch(error);
  }
}

v1::Response Connection::call(v1::Request request) {
  const Clock::time_point deadline = Clock::now() + timeout_;
  v1::Envelope envelope;
  request.set_id(++last_request_);
  *envelope.mutable_request() = std::move(request);
  send(envelope, deadline);
  while (true) {
    std::optional<v1::Envelope> answer = read(deadline, false);
    if (!answer) {
      throw Unreachable("the daemon at " + name_ + " did not answer within " + seconds(timeout_));
    }
    if (!answer->has_response()) {
      keep(std::move(*answer));
      continue;
    }
    if (answer->response().id() != last_request_) {
      continue;  // the late answer of a call that was given up
    }
    if (answer->response().has_error()) {
      throw_error(answer->response().error());
    }
    return std::move(*answer->mutable_response());
  }
}

std::uint32_t Connection::subscribe(const std::vector<v1::Topic>& topics, std::uint32_t decimation) {
  v1::Subscribe subscription;
  for (const v1::Topic topic : topics) {
    subscription.add_topic(topic);
  }
  subscription.set_decimation(decimation);
  return subscribe(std::move(subscription));
}

std::uint32_t Connection::subscribe(v1::Subscribe subscription) {
  v1::Request request;
  *request.mutable_subscribe() = std::move(subscription);
  return call(std::move(request)).subscribed().subscription();
}

std::chrono::milliseconds Connection::acquire_drive(std::chrono::milliseconds silence) {
  v1::Request request;
  request.mutable_acquire_drive()->set_heartbeat_ms(static_cast<std::uint32_t>(silence.count()));
  const std::chrono::milliseconds agreed(call(std::move(request)).drive_lease().heartbeat_ms());
  beat_every_ = std::max(agreed / kBeatsInSilence, std::chrono::milliseconds(1));
  next_beat_ = Clock::now() + *beat_every_;
  return agreed;
}

void Connection::release_drive() {
  if (!beat_every_) {
    return;
  }
  beat_every_.reset();
  v1::Request request;
  request.mutable_release_drive();
  call(std::move(request));
}

void Connection::beat_if_due() {
  if (!beat_every_ || Clock::now() < next_beat_) {
    return;
  }
  next_beat_ = Clock::now() + *beat_every_;
  v1::Envelope envelope;
  envelope.mutable_request()->set_id(kHeartbeat);
  envelope.mutable_request()->mutable_heartbeat();
  send(envelope, Clock::now() + timeout_);
}

void Connection::take_beat(const v1::Response& response) {
  // of one that came before the lease was released, or that the daemon was too busy for, nothing follows
  if (!beat_every_ || response.error().code() != v1::Error::NOT_FOUND) {
    return;
  }
  beat_every_.reset();
  v1::Error error;
  error.set_code(v1::Error::FAILED);
  error.set_message("the drive lease is lost: the daemon heard no heartbeat in time");
  throw_error(error);
}

void Connection::unsubscribe(std::uint32_t subscription) {
  v1::Request request;
  request.mutable_unsubscribe()->set_subscription(subscription);
  call(std::move(request));
  std::erase_if(kept_, [subscription](const v1::Envelope& message) {
    return message.has_frame() && message.frame().subscription() == subscription;
  });
}

std::optional<v1::Envelope> Connection::receive(std::chrono::milliseconds timeout) {
  const Clock::time_point deadline = Clock::now() + timeout;
  beat_if_due();
  while (kept_.empty()) {
    std::optional<v1::Envelope> message = read(deadline, true);
    if (!message) {
      return std::nullopt;
    }
    if (!message->has_response()) {
      keep(std::move(*message));
    }
  }
  v1::Envelope first = std::move(kept_.front());
  kept_.pop_front();
  return first;
}

void Connection::keep(v1::Envelope message) {
  if (!message.has_batch()) {
    kept_.push_back(std::move(message));
    return;
  }
  for (v1::Frame& frame : *message.mutable_batch()->mutable_frame()) {
    *kept_.emplace_back().mutable_frame() = std::move(frame);
  }
}

void Connection::send(const v1::Envelope& envelope, Clock::time_point deadline) {
  std::string bytes;
  proto::append_frame(envelope, bytes);
  switch (tls_ ? tls_->send(socket_, bytes, deadline) : socket_.send(bytes, deadline)) {
    case StreamSocket::Outcome::kDone:
      return;
    case StreamSocket::Outcome::kTimedOut:
      throw Unreachable("the daemon at " + name_ + " takes no requests");
    default:
      throw_gone();
  }
}

StreamSocket::Outcome Connection::receive_some(std::size_t& received, Clock::time_point deadline) {
  return tls_ ? tls_->receive(socket_, chunk_, received, deadline)
              : socket_.receive(chunk_, received, deadline);
}

// the next envelope of a kind this program knows; a goodbye is thrown
std::optional<v1::Envelope> Connection::read(Clock::time_point deadline, bool until_signal) {
  while (true) {
    beat_if_due();
    std::optional<std::string_view> message;
    try {
      message = reader_.next();
    } catch (const proto::FramingError& error) {
      throw Unreachable("what listens at " + name_ + " is not a hapticd: " + error.what());
    }
    if (message) {
      v1::Envelope envelope;
      if (!envelope.ParseFromArray(message->data(), static_cast<int>(message->size()))) {
        throw Unreachable("what listens at " + name_ + " is not a hapticd: a message cannot be read");
      }
      if (envelope.has_goodbye()) {
        throw_goodbye(envelope.goodbye().error());
      }
      if (envelope.body_case() == v1::Envelope::BODY_NOT_SET) {
        continue;  // from a newer daemon
      }
      if (envelope.response().id() == kHeartbeat) {
        take_beat(envelope.response());
        continue;
      }
      return envelope;
    }
    std::size_t received = 0;
    switch (receive_some(received, beat_every_ ? std::min(deadline, next_beat_) : deadline)) {
      case StreamSocket::Outcome::kDone:
        reader_.append(std::string_view(chunk_.data(), received));
        break;
      case StreamSocket::Outcome::kInterrupted:
        if (until_signal) {
          return std::nullopt;
        }
        break;
      case StreamSocket::Outcome::kTimedOut:
        if (Clock::now() >= deadline) {
          return std::nullopt;
        }
        break;  // a heartbeat is due
      case StreamSocket::Outcome::kClosed:
        throw Unreachable("the daemon at " + name_ + " closed the connection" +
                          (tls_ && !tls_->problem().empty() ? ": " + tls_->problem() : ""));
    }
  }
}

// nothing can be sent any more, but why may already be waiting to be read
void Connection::throw_gone() {
  beat_every_.reset();
  const Clock::time_point deadline = Clock::now() + std::chrono::milliseconds(200);
  while (read(deadline, false)) {
  }
  throw Unreachable("the daemon at " + name_ + " closed the connection");
}

}  // namespace haptic::client
