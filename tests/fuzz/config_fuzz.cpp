// Configs, as text format or JSON: accepted with every default in its range, or refused with a LoadError.

#include <cstdlib>

#include "load/config_file.h"
#include "tests/fuzz/text_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  const std::string text = fuzz::text_of(data, size);
  try {
    v1::DaemonConfig message;
    const load::TextSource source = load::parse_message(text, "f", fuzz::syntax_of(text), message);
    // CSV files are not what is tried here
    for (const v1::Device& device : message.device()) {
      if (device.has_playback() || device.simulated().has_hand()) return 0;
    }
    const load::LoadedConfig config = load::check_config(message, source, "/none/f");
    const double rate = config.message.servo().rate_hz();
    if (!(rate >= 100.0 && rate <= 8000.0) || config.message.capacity().hips() == 0) std::abort();
  } catch (const load::LoadError&) {
    return 0;
  }
  return 0;
}
