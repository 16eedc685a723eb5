// A whole session, from the first byte of a client to its end: what it says before it has said hello, as
// somebody who may not use the daemon at all, and after. The first byte chooses who it is (its two lowest
// bits) and in pieces of how many bytes it sends. Whatever comes:
//
//     nothing but a goodbye is said to one without a role, or whose first message is no hello
//     hello is said once, before everything else, and nothing after goodbye
//     nothing reaches the servo thread before hello was answered, or from one that may only observe

#include <algorithm>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/session.h"
#include "proto/framing.h"
#include "proto/protocol.h"
#include "tests/fuzz/office.h"
#include "tests/fuzz/schema_mutator.h"

namespace {

using namespace haptic;
namespace asio = boost::asio;

void demand(bool condition) {
  if (!condition) {
    std::abort();
  }
}

// what a session is called back with waits here until it is wanted
class Wire final : public ipc::Stream {
 public:
  explicit Wire(asio::io_context& io) : io_(io) {}

  void read_some(asio::mutable_buffer buffer, OnBytes on_bytes) override {
    buffer_ = buffer;
    reading_ = std::move(on_bytes);
  }
  void write(const std::vector<asio::const_buffer>& buffers, OnBytes on_bytes) override {
    for (const asio::const_buffer& buffer : buffers) {
      said_.append(static_cast<const char*>(buffer.data()), buffer.size());
    }
    writing_ = std::move(on_bytes);
  }
  void end_writing() override {}
  void close() noexcept override {}
  Socket::executor_type executor() override { return io_.get_executor(); }

  /// As much of it as is asked for.
  std::size_t send(std::string_view bytes) {
    const std::size_t size = std::min(bytes.size(), buffer_.size());
    std::copy_n(bytes.data(), size, static_cast<char*>(buffer_.data()));
    call(reading_, {}, size);
    return size;
  }
  void flush() {
    while (writing_) {
      call(writing_, {}, 0);
    }
  }
  void end() {
    if (reading_) {
      call(reading_, asio::error::eof, 0);
    }
    flush();
  }
  bool is_read() const noexcept { return static_cast<bool>(reading_); }
  const std::string& said() const noexcept { return said_; }

 private:
  static void call(OnBytes& callback, const boost::system::error_code& error, std::size_t size) {
    const OnBytes taken = std::exchange(callback, nullptr);
    taken(error, size);
  }

  asio::io_context& io_;
  asio::mutable_buffer buffer_;
  OnBytes reading_;
  OnBytes writing_;
  std::string said_;
};

// looks at what has been said so far
class Listener {
 public:
  explicit Listener(bool may_be_greeted) : may_be_greeted_(may_be_greeted) {}

  void listen(std::string_view said) {
    reader_.append(said.substr(heard_));
    heard_ = said.size();
    while (const auto message = reader_.next()) {
      v1::Envelope envelope;
      demand(envelope.ParseFromArray(message->data(), static_cast<int>(message->size())));
      demand(!is_over_);
      if (envelope.has_hello()) {
        demand(may_be_greeted_ && !is_greeted_);
        is_greeted_ = true;
      } else if (envelope.has_goodbye()) {
        is_over_ = true;
      } else {
        demand(is_greeted_);
      }
    }
  }
  bool is_greeted() const noexcept { return is_greeted_; }

 private:
  proto::FrameReader reader_{proto::kReplyLimit};
  std::size_t heard_ = 0;
  bool may_be_greeted_;
  bool is_greeted_ = false;
  bool is_over_ = false;
};

bool begins_with_hello(std::string_view bytes) {
  proto::FrameReader reader(proto::kGreetingLimit);
  reader.append(bytes);
  try {
    const auto first = reader.next();
    v1::Envelope envelope;
    return first && envelope.ParseFromArray(first->data(), static_cast<int>(first->size())) &&
           envelope.has_hello();
  } catch (const proto::FramingError&) {
    return false;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  ipc::Peer peer;
  peer.user = peer.name = "somebody";
  peer.refusal = "you may not";
  constexpr v1::Role kRoles[] = {v1::ROLE_UNSPECIFIED, v1::OBSERVE, v1::DRIVE, v1::ADMIN};
  const v1::Role role = kRoles[data[0] % 4U];
  if (role != v1::ROLE_UNSPECIFIED) {
    peer.role = role;
  }
  const std::size_t piece = data[0] / 4U;  // 0: all at once
  std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);

  const auto office = std::make_unique<fuzz::Office>();
  asio::io_context io;
  const auto wire = std::make_shared<Wire>(io);
  Listener listener(role != v1::ROLE_UNSPECIFIED && begins_with_hello(bytes));
  bool has_ended = false;
  const auto session = std::make_shared<ipc::Session>(1, wire, peer, ipc::SessionLimits(), office->desk(),
                                                      [&](ipc::ClientId) { has_ended = true; });
  session->start();
  while (!bytes.empty() && wire->is_read()) {
    bytes.remove_prefix(wire->send(bytes.substr(0, piece == 0 ? bytes.size() : piece)));
    wire->flush();
    listener.listen(wire->said());
    const bool is_idle = office->obey() == 0;
    demand(is_idle || (listener.is_greeted() && role > v1::OBSERVE));
    wire->flush();
    listener.listen(wire->said());
  }
  wire->end();
  demand(has_ended);
  return 0;
}

// three times of four as the schema allows; bytes at random for the rest
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  haptic::fuzz::Random random(seed);
  const std::size_t mutated =
      random() % 4 == 0 ? 0 : haptic::fuzz::mutate_conversation(data, size, max_size, random);
  return mutated > 0 ? mutated : LLVMFuzzerMutate(data, size, max_size);
}
