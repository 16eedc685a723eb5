// A client of release 0.1, as somebody else might have written it: plain sockets, the schema of its time,
// nothing else. Frozen. usage: client SOCKET; exit code 0 if the daemon did all that a client of this release
// relies on.

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "haptic/v1/control.pb.h"

namespace {

using namespace haptic::v1;

int daemon_socket = -1;

void require(bool holds, const char* what) {
  if (!holds) {
    std::fprintf(stderr, "client 0.1: %s\n", what);
    std::exit(1);
  }
}

void connect_to(const char* path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  require(std::strlen(path) < sizeof(name.sun_path), "the path is too long");
  std::strcpy(name.sun_path, path);
  daemon_socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  const timeval patience{10, 0};
  ::setsockopt(daemon_socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  require(::connect(daemon_socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0,
          "cannot connect");
}

void send(const Envelope& envelope) {
  const std::string body = envelope.SerializeAsString();
  std::string bytes;
  std::size_t length = body.size();
  while (length >= 128) {
    bytes.push_back(static_cast<char>(length % 128 + 128));
    length /= 128;
  }
  bytes.push_back(static_cast<char>(length));
  bytes += body;
  require(
      ::send(daemon_socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size()),
      "cannot send");
}

char next_byte() {
  char byte = 0;
  require(::recv(daemon_socket, &byte, 1, MSG_WAITALL) == 1, "the daemon closed, or is silent");
  return byte;
}

Envelope receive() {
  std::size_t length = 0;
  int shift = 0;
  unsigned char byte = 0;
  do {
    byte = static_cast<unsigned char>(next_byte());
    length |= static_cast<std::size_t>(byte & 127U) << shift;
    shift += 7;
  } while (byte >= 128);
  std::string body(length, '\0');
  require(::recv(daemon_socket, body.data(), length, MSG_WAITALL) == static_cast<ssize_t>(length),
          "a message is cut short");
  Envelope envelope;
  require(envelope.ParseFromString(body), "a message cannot be read");
  require(!envelope.has_goodbye(), "the daemon said goodbye");
  return envelope;
}

// the answer; frames and events before it are no concern of the caller
Response answer_to(Request request) {
  static std::uint64_t last = 0;
  request.set_id(++last);
  Envelope envelope;
  *envelope.mutable_request() = request;
  send(envelope);
  while (true) {
    Envelope reply = receive();
    if (reply.has_response() && reply.response().id() == last) {
      require(!reply.response().has_error(), reply.response().error().message().c_str());
      return reply.response();
    }
  }
}

void greet() {
  Envelope envelope;
  Hello& mine = *envelope.mutable_hello();
  mine.set_major(1);
  mine.set_minor(0);
  mine.set_program("client");
  mine.set_version("0.1");
  send(envelope);
  const Envelope theirs = receive();
  require(theirs.has_hello() && theirs.hello().major() == 1, "no hello of major 1");
  require(theirs.hello().role() == ADMIN, "the role is not told");
}

void ask_status() {
  Request request;
  request.mutable_get_status();
  const Response response = answer_to(request);
  require(response.status().rate_hz() > 0.0 && response.status().devices() == 1, "no status");
}

// plain frames one by one, each tick
void read_frames() {
  Request request;
  for (const Topic topic : {OBJECTS, HIPS, DEVICES}) {
    request.mutable_subscribe()->add_topic(topic);
  }
  const std::uint32_t subscription = answer_to(request).subscribed().subscription();
  std::uint64_t next = 1;
  while (next <= 20) {
    const Envelope message = receive();
    require(!message.has_batch(), "a batch came, unasked");
    if (message.has_gap()) {
      next = message.gap().last_sequence() + 1;
    } else if (message.has_frame()) {
      const Frame& frame = message.frame();
      require(frame.subscription() == subscription && frame.sequence() == next, "a sequence is wrong");
      require(frame.objects().position_size() == 3, "no object");
      require(frame.hips().position_size() == 6, "no HIPs");
      require(frame.devices().position_size() == 3, "no device");
      ++next;
    }
  }
  request.mutable_unsubscribe()->set_subscription(subscription);
  require(answer_to(request).has_done(), "cannot unsubscribe");
}

// frames in batches, of chosen parts, with events among them
void read_batches() {
  Request request;
  Subscribe& wish = *request.mutable_subscribe();
  wish.add_topic(HIPS);
  wish.add_topic(EVENTS);
  wish.set_delivery(LOSSLESS);
  wish.set_decimation(2);
  wish.add_finger("thumb");
  const std::uint32_t subscription = answer_to(request).subscribed().subscription();
  int frames = 0;
  while (frames < 10) {
    const Envelope message = receive();
    for (const Frame& frame : message.batch().frame()) {
      require(frame.subscription() == subscription, "a frame of another subscription");
      ++frames;
    }
    if (message.has_frame()) {
      require(message.frame().hips().hip_size() == 2, "no numbers of HIPs");
      ++frames;
    }
  }
}

void arm_and_disarm() {
  Request request;
  request.mutable_arm();
  require(answer_to(request).has_done(), "cannot arm");
  request.mutable_disarm();
  require(answer_to(request).has_done(), "cannot disarm");
}

}  // namespace

int main(int argc, char** argv) {
  require(argc == 2, "usage: client SOCKET");
  connect_to(argv[1]);
  greet();
  ask_status();
  read_frames();
  read_batches();
  arm_and_disarm();
  ::close(daemon_socket);
  return 0;
}
