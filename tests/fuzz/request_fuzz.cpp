// What a client may send after hello: arbitrary bytes as a stream of envelopes, whose requests are
// dispatched. The first byte chooses the client's role. Whatever comes: each request is answered at most
// once, and an observer's change nothing in the servo thread.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "ipc/dispatch.h"
#include "proto/framing.h"
#include "proto/protocol.h"
#include "tests/fuzz/schema_mutator.h"

namespace {

using namespace haptic;

class Office {
 public:
  void ask(const v1::Request& request, v1::Role role) {
    const auto answers = std::make_shared<int>(0);
    const ipc::Caller caller{.id = 1, .role = role, .sink = {}, .drop_frames = [](std::uint32_t) {}};
    ipc::dispatch(desk_, caller, request, ipc::Reply(request.id(), [answers](v1::Response&& response) {
                    static_cast<void>(response.SerializeAsString());
                    if (++*answers > 1) {
                      std::abort();
                    }
                  }));
    servo::Command command;
    while (mailbox_.commands.pop(command)) {
      if (role == v1::OBSERVE && command.kind != servo::CommandKind::kCopyState) {
        std::abort();
      }
      mailbox_.events.push({.command = command.kind, .request = command.request, .copy = command.copy});
    }
    servo_.poll({});
  }

 private:
  static ipc::BuiltScene refuse(const v1::LoadScene& /*request*/) {
    throw ipc::SceneError(ipc::make_error(v1::Error::FAILED, "no scene is built here"));
  }

  servo::Mailbox mailbox_{servo::Capacity{1, 1, 1, 1, 1}};
  ipc::Services services_{.mailbox = mailbox_,
                          .version = "1",
                          .rate_hz = 1000.0,
                          .devices = {},
                          .real_time = {},
                          .scene = {},
                          .build_scene = refuse};
  ipc::ServoLink servo_{mailbox_, std::chrono::seconds(1), [](const servo::Event&) {}};
  ipc::SceneStore scenes_{services_, servo_};
  ipc::Publisher publisher_;
  ipc::Desk desk_{services_, servo_, scenes_, publisher_, {}, [] { return std::size_t{1}; }};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const auto office = std::make_unique<Office>();
  const v1::Role role = data[0] % 2 == 0 ? v1::OBSERVE : v1::ADMIN;
  proto::FrameReader reader(proto::kRequestLimit);
  reader.append(std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  try {
    while (const auto message = reader.next()) {
      v1::Envelope envelope;
      if (envelope.ParseFromArray(message->data(), static_cast<int>(message->size())) &&
          envelope.has_request()) {
        office->ask(envelope.request(), role);
      }
    }
  } catch (const proto::FramingError&) {
    return 0;
  }
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
