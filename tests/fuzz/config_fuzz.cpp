// Configs, as text format or JSON: accepted with every default in its range, or refused with a LoadError.

#include <cstdlib>

#include "load/config_file.h"
#include "tests/fuzz/schema_mutator.h"
#include "tests/fuzz/text_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  const std::string text = fuzz::text_of(data, size);
  try {
    v1::DaemonConfig message;
    const load::TextSource source = load::parse_message(text, "f", fuzz::syntax_of(text), message);
    // files that it names are not what is tried here
    for (const v1::Device& device : message.device()) {
      if (device.has_playback() || device.simulated().has_hand()) return 0;
      if (!device.falcon().firmware().empty() || !device.phantom().calibration().empty()) return 0;
    }
    const load::LoadedConfig config = load::check_config(message, source, "/none/f");
    const double rate = config.message.servo().rate_hz();
    if (!(rate >= 100.0 && rate <= 8000.0) || config.message.capacity().hips() == 0) std::abort();
  } catch (const load::LoadError&) {
    return 0;
  }
  return 0;
}

// three times of four as the schema allows; bytes at random for the rest, and for JSON
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  haptic::fuzz::Random random(seed);
  haptic::v1::DaemonConfig scratch;
  const std::size_t mutated =
      random() % 4 == 0 ? 0 : haptic::fuzz::mutate_text(scratch, data, size, max_size, random);
  return mutated > 0 ? mutated : LLVMFuzzerMutate(data, size, max_size);
}
