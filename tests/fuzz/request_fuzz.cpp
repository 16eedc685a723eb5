// What a client may send after hello: arbitrary bytes as a stream of envelopes, whose requests are
// dispatched. The first byte chooses the client's role. Whatever comes: each request is answered at most
// once, and an observer's change nothing in the servo thread.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "proto/framing.h"
#include "proto/protocol.h"
#include "tests/fuzz/office.h"
#include "tests/fuzz/schema_mutator.h"

namespace {

using namespace haptic;

void ask(fuzz::Office& office, const v1::Request& request, v1::Role role) {
  const auto answers = std::make_shared<int>(0);
  ipc::Caller caller;
  caller.id = 1;
  caller.role = role;
  caller.drop_frames = [](std::uint32_t) {};
  ipc::dispatch(office.desk(), caller, request, ipc::Reply(request.id(), [answers](v1::Response&& response) {
                  static_cast<void>(response.SerializeAsString());
                  if (++*answers > 1) {
                    std::abort();
                  }
                }));
  if (office.obey() > 0 && role == v1::OBSERVE) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const auto office = std::make_unique<fuzz::Office>();
  const v1::Role role = data[0] % 2 == 0 ? v1::OBSERVE : v1::ADMIN;
  proto::FrameReader reader(proto::kRequestLimit);
  reader.append(std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  try {
    while (const auto message = reader.next()) {
      v1::Envelope envelope;
      if (envelope.ParseFromArray(message->data(), static_cast<int>(message->size())) &&
          envelope.has_request()) {
        ask(*office, envelope.request(), role);
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
