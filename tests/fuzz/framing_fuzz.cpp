// The frame splitter under arbitrary bytes in arbitrary chunks. The first byte chooses the size of the
// chunks. Whatever the bytes are: the messages do not depend on the chunks, and none is longer than the
// limit.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "haptic/v1/control.pb.h"
#include "proto/framing.h"

namespace {

constexpr std::size_t kLimit = 4096;

struct Reading {
  std::vector<std::string> messages;
  bool broken = false;
};

Reading read_in_chunks(std::string_view bytes, std::size_t chunk) {
  Reading reading;
  haptic::proto::FrameReader reader(kLimit);
  try {
    for (std::size_t at = 0; at < bytes.size(); at += chunk) {
      reader.append(bytes.substr(at, chunk));
      while (const auto message = reader.next()) {
        reading.messages.emplace_back(*message);
      }
    }
  } catch (const haptic::proto::FramingError&) {
    reading.broken = true;
  }
  return reading;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const Reading whole = read_in_chunks(bytes, std::max<std::size_t>(1, bytes.size()));
  const Reading chunked = read_in_chunks(bytes, std::size_t{data[0]} + 1);
  if (whole.messages != chunked.messages || whole.broken != chunked.broken) {
    std::abort();
  }
  for (const std::string& message : whole.messages) {
    if (message.size() > kLimit) {
      std::abort();
    }
    haptic::v1::Envelope envelope;
    envelope.ParseFromString(message);
  }
  return 0;
}
