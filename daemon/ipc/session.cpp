#include "ipc/session.h"

#include <spdlog/spdlog.h>

#include <exception>

#include "ipc/message_counts.h"

namespace haptic::ipc {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

// one write: enough to be efficient, little enough that control does not wait long behind it
constexpr std::size_t kBatchBytes = std::size_t{64} * 1024;

// what a client says about itself, of which others are told: short, and nothing that a terminal would obey
std::string printable(const std::string& text) {
  constexpr std::size_t kLongest = 64;
  std::string out;
  for (const char c : text.substr(0, kLongest)) {
    out += c >= ' ' && c <= '~' ? c : '?';
  }
  return out;
}

std::string version_text(std::uint32_t major, std::uint32_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

}  // namespace

Session::Session(ClientId id, std::shared_ptr<Stream> stream, Peer peer, const SessionLimits& limits,
                 Desk& desk, OnEnd on_end)
    : id_(id),
      stream_(std::move(stream)),
      peer_(std::move(peer)),
      limits_(limits),
      desk_(desk),
      on_end_(std::move(on_end)),
      timer_(stream_->executor()),
      reader_(limits.greeting_bytes),
      chunk_{},
      outbox_(limits.outbox),
      rate_(limits.requests_per_second, SteadyClock::now()) {
  caller_.id = id;
  caller_.role = peer_.role.value_or(v1::ROLE_UNSPECIFIED);
  caller_.name = peer_.name;
  caller_.subscriptions = limits.subscriptions;
  caller_.answer_bytes = limits.outbox.control_bytes;
}

void Session::start() {
  const std::weak_ptr<Session> weak = weak_from_this();
  caller_.sink = [weak](const OutgoingFrame& frame) {
    const auto self = weak.lock();
    if (self && self->state_ == State::kServing) {
      self->outbox_.push_frame(frame);
      self->write();
    }
  };
  caller_.drop_frames = [weak](std::uint32_t subscription) {
    if (const auto self = weak.lock()) {
      self->outbox_.forget(subscription);
    }
  };
  timer_.expires_after(limits_.hello);
  timer_.async_wait([weak](const error_code& error) {
    const auto self = weak.lock();
    if (!error && self && self->state_ == State::kConnected) {
      self->cut_off(make_error(v1::Error::INVALID, "no hello came in time"));
    }
  });
  read();
}

void Session::read() {
  stream_->read_some(asio::buffer(chunk_),
                     [self = shared_from_this()](const error_code& error, std::size_t size) {
                       if (error) {
                         self->end();
                         return;
                       }
                       self->take_bytes(size);
                       if (self->state_ != State::kEnded) {
                         self->read();
                       }
                     });
}

void Session::take_bytes(std::size_t size) {
  if (state_ == State::kLeaving) {
    return;  // read only so that the goodbye is not lost with what the client still sends
  }
  reader_.append(std::string_view(chunk_.data(), size));
  try {
    while (state_ == State::kConnected || state_ == State::kServing) {
      const auto message = reader_.next();
      if (!message) {
        return;
      }
      take_message(*message);
    }
  } catch (const proto::FramingError& error) {
    cut_off(make_error(v1::Error::INVALID, error.what()));
  }
}

void Session::take_message(std::string_view bytes) {
  v1::Envelope envelope;
  if (!envelope.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    cut_off(make_error(v1::Error::INVALID, "a message cannot be read as an envelope"));
  } else if (state_ == State::kConnected) {
    take_hello(envelope);
  } else if (envelope.has_request()) {
    take_request(envelope.request());
  } else if (envelope.body_case() != v1::Envelope::BODY_NOT_SET) {
    cut_off(make_error(v1::Error::INVALID, "after hello a client sends requests only"));
  }
}

void Session::take_hello(const v1::Envelope& envelope) {
  if (!envelope.has_hello()) {
    cut_off(make_error(v1::Error::INVALID, "the first message must be hello"));
    return;
  }
  if (!peer_.role) {
    cut_off(make_error(v1::Error::REFUSED, peer_.refusal));
    return;
  }
  if (const auto error = check_counts(envelope, limits_.items)) {
    cut_off(*error);
    return;
  }
  const v1::Hello& theirs = envelope.hello();
  push_control(hello());
  if (theirs.major() != proto::kProtocolMajor) {
    cut_off(make_error(v1::Error::MISMATCH,
                       "hapticd " + desk_.services.version + " speaks protocol " +
                           version_text(proto::kProtocolMajor, proto::kProtocolMinor) + ", " +
                           (theirs.program().empty() ? "the client" : theirs.program()) + " " +
                           theirs.version() + " speaks " + version_text(theirs.major(), theirs.minor()) +
                           "; install matching versions"));
    return;
  }
  caller_.program = printable(theirs.program());
  timer_.cancel();
  reader_.set_limit(limits_.request_bytes);
  state_ = State::kServing;
}

v1::Envelope Session::hello() const {
  v1::Envelope envelope;
  v1::Hello& mine = *envelope.mutable_hello();
  mine.set_major(proto::kProtocolMajor);
  mine.set_minor(proto::kProtocolMinor);
  for (const std::string_view feature : proto::kFeatures) {
    mine.add_feature(std::string(feature));
  }
  mine.set_program("hapticd");
  mine.set_version(desk_.services.version);
  mine.set_role(caller_.role);
  *mine.mutable_warning() = desk_.services.real_time.warning();
  mine.set_scene_revision(desk_.scenes.current().revision());
  return envelope;
}

void Session::take_request(const v1::Request& request) {
  const std::weak_ptr<Session> weak = weak_from_this();
  ++open_requests_;
  const Reply reply(request.id(), [weak](v1::Response&& response) {
    const auto self = weak.lock();
    if (!self) {
      return;
    }
    --self->open_requests_;
    v1::Envelope envelope;
    *envelope.mutable_response() = std::move(response);
    const std::size_t bytes = envelope.ByteSizeLong();
    if (bytes > self->caller_.answer_bytes) {
      const std::uint64_t id = envelope.response().id();
      envelope.mutable_response()->Clear();
      envelope.mutable_response()->set_id(id);
      *envelope.mutable_response()->mutable_error() = make_error(
          v1::Error::INVALID, "the answer has " + std::to_string(bytes) +
                                  " bytes, more than can be sent to you (limits.pending_control of "
                                  "the config)");
    }
    self->push_control(envelope);
  });
  if (!is_within_limits(request, reply)) return;
  try {
    dispatch(desk_, caller_, request, reply);
  } catch (const std::exception& error) {
    // a defect of ours; it ends this client, and neither the others nor the devices
    spdlog::error("a request failed unexpectedly: {}", error.what());
    cut_off(make_error(v1::Error::FAILED, "the daemon failed in this request; its log tells more"));
  }
}

// if not, the request is answered, or the client cut off
bool Session::is_within_limits(const v1::Request& request, const Reply& reply) {
  // nobody is ever too busy to end all force
  if (request.has_emergency_stop()) return true;
  const auto verdict = request.has_disarm() ? RequestRate::Verdict::kTaken : rate_.take(SteadyClock::now());
  const std::string rate = std::to_string(limits_.requests_per_second) + " requests in a second";
  if (verdict == RequestRate::Verdict::kFlood) {
    cut_off(make_error(v1::Error::BUSY, "you have sent far more than " + rate + ", which is all you may"));
    return false;
  }
  if (verdict == RequestRate::Verdict::kTooMany) {
    reply.fail(v1::Error::BUSY, "you may send " + rate + "; wait, and try again");
    return false;
  }
  if (open_requests_ > limits_.open_requests) {
    reply.fail(v1::Error::BUSY, std::to_string(limits_.open_requests) + " requests wait for their answers");
    return false;
  }
  if (const auto error = check_counts(request, limits_.items)) {
    reply.fail(*error);
    return false;
  }
  return true;
}

void Session::tell(const std::string& framed_event) {
  if (state_ != State::kServing) {
    return;
  }
  if (!outbox_.push_control(framed_event)) {
    cut_off(make_error(v1::Error::FAILED, "you read too slowly: the answers and events for you overflow"));
    return;
  }
  write();
}

void Session::push_control(const v1::Envelope& envelope) {
  if (state_ != State::kConnected && state_ != State::kServing) {
    return;
  }
  std::string bytes;
  proto::append_frame(envelope, bytes);
  if (!outbox_.push_control(std::move(bytes))) {
    cut_off(make_error(v1::Error::FAILED, "you read too slowly: the answers and events for you overflow"));
    return;
  }
  write();
}

void Session::cut_off(const v1::Error& error) {
  if (state_ == State::kLeaving || state_ == State::kEnded) {
    return;
  }
  desk_.publisher.forget(id_);
  desk_.lease.forget(id_, SteadyClock::now());
  if (state_ == State::kServing) {
    outbox_.clear();
  }
  state_ = State::kLeaving;
  v1::Envelope envelope;
  *envelope.mutable_goodbye()->mutable_error() = error;
  std::string bytes;
  proto::append_frame(envelope, bytes);
  outbox_.push_control(std::move(bytes));
  timer_.expires_after(limits_.goodbye);
  timer_.async_wait([weak = weak_from_this()](const error_code& failure) {
    const auto self = weak.lock();
    if (!failure && self) {
      self->end();
    }
  });
  write();
}

void Session::write() {
  if (!writing_.empty() || state_ == State::kEnded) {
    return;
  }
  writing_ = outbox_.take(kBatchBytes);
  if (writing_.empty()) {
    if (state_ == State::kLeaving) {
      // the client sees the end after its goodbye; reading goes on until it closes, or time is up
      stream_->end_writing();
    }
    return;
  }
  std::vector<asio::const_buffer> buffers;
  for (const Piece& piece : writing_) {
    buffers.push_back(asio::buffer(piece.own));
    if (piece.shared) {
      buffers.push_back(asio::buffer(*piece.shared));
    }
  }
  stream_->write(buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
    self->writing_.clear();
    if (error) {
      self->end();
    } else {
      self->write();
    }
  });
}

void Session::end() {
  if (state_ == State::kEnded) {
    return;
  }
  state_ = State::kEnded;
  desk_.publisher.forget(id_);
  desk_.lease.forget(id_, SteadyClock::now());
  outbox_.clear();
  timer_.cancel();
  stream_->close();
  on_end_(id_);
}

}  // namespace haptic::ipc
