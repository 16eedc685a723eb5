// The reader of recordings and their recovery under arbitrary bytes. Whatever they are: what is recovered
// from them is a whole file with as many messages as was told, in the order of time.

#include <google/protobuf/message.h>
#include <google/protobuf/stubs/logging.h>

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "haptic/v1/telemetry.pb.h"
#include "proto/recording/error.h"
#include "proto/recording/recording.h"
#include "proto/recording/recover.h"
#include "proto/recording/schema_set.h"
#include "tests/support/memory_sink.h"

namespace {

using namespace haptic::recording;

// one item that is broken says nothing about the next
template <class Do>
void or_broken(Do action) {
  try {
    action();
  } catch (const FormatError&) {
    return;
  }
}

std::uint64_t count_messages(const Recording& recording) {
  std::uint64_t count = 0;
  std::uint64_t last = 0;
  Messages messages = recording.messages();
  for (; messages.next(); ++count) {
    if (messages.message().log_time < last) {
      std::abort();
    }
    last = messages.message().log_time;
    or_broken([&] {
      haptic::v1::Frame frame;
      messages.parse(frame);
    });
  }
  return count;
}

void read_all(const Source& source) {
  const Recording recording(source);
  or_broken([&] { count_messages(recording); });
  for (const AttachmentIndex& attachment : recording.attachments()) {
    or_broken([&] { recording.read(attachment); });
  }
  for (const MetadataIndex& metadata : recording.metadata()) {
    or_broken([&] { recording.read(metadata); });
  }
  for (const auto& [id, schema] : recording.schemas()) {
    or_broken([&, &tried = schema] { EmbeddedType(tried).parse("\x08\x01"); });
  }
}

void recover_all(const Source& source) {
  haptic::test::MemorySink sink;
  Writer writer(sink, {.library = library_of(source)});
  const Recovered told = recover(source, writer);
  const MemorySource recovered(sink.bytes);
  const Recording recording(recovered);
  if (!recording.damage().empty() || recording.statistics().message_count != told.messages ||
      recording.attachments().size() != told.attachments || count_messages(recording) != told.messages) {
    std::abort();
  }
}

}  // namespace

// what protobuf thinks of each input is of no use
extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  google::protobuf::SetLogHandler(nullptr);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemorySource source(std::string_view(reinterpret_cast<const char*>(data), size));
  or_broken([&] { read_all(source); });
  or_broken([&] { recover_all(source); });
  return 0;
}
