// What a page may send: arbitrary bytes as a stream of envelopes, whose requests are judged. The first byte
// tells its rights. Whatever comes: an observer's request that goes on only observes, nobody's changes a
// scene, and every subscription that goes on is one that a slow page cannot make grow.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "client/view/policy.h"
#include "proto/framing.h"
#include "proto/protocol.h"
#include "tests/fuzz/schema_mutator.h"

namespace {

using namespace haptic;

constexpr std::uint32_t kLeast = 17;

bool only_observes(const v1::Request& request) {
  return request.has_get_status() || request.has_list_devices() || request.has_get_scene() ||
         (request.has_get_stats() && !request.get_stats().reset()) || request.has_subscribe() ||
         request.has_unsubscribe() || request.has_list_faults();
}

void judge(v1::Request request, gateway::Rights rights) {
  const auto error = gateway::judge(request, rights, kLeast);
  if (error) {
    if (error->code() != v1::Error::REFUSED || error->message().empty()) std::abort();
    return;
  }
  if (rights == gateway::Rights::kObserve && !only_observes(request)) std::abort();
  if (request.has_load_scene() || request.has_edit_scene() || request.has_get_state() ||
      request.has_manage_device() || request.call_case() == v1::Request::CALL_NOT_SET) {
    std::abort();
  }
  if (request.has_subscribe()) {
    const v1::Subscribe& wish = request.subscribe();
    if (wish.delivery() != v1::LATEST || wish.decimation() < kLeast) std::abort();
    for (const int topic : wish.topic()) {
      if (topic == v1::INPUTS) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const auto rights = data[0] % 2 == 0 ? gateway::Rights::kObserve : gateway::Rights::kDrive;
  proto::FrameReader reader(proto::kRequestLimit);
  reader.append(std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1));
  try {
    while (const auto message = reader.next()) {
      v1::Envelope envelope;
      if (!envelope.ParseFromArray(message->data(), static_cast<int>(message->size()))) {
        continue;
      }
      if (envelope.has_request()) {
        judge(envelope.request(), rights);
      } else if (envelope.has_hello() && rights == gateway::Rights::kObserve &&
                 gateway::hello_for(rights, envelope.hello()).role() > v1::OBSERVE) {
        std::abort();
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
