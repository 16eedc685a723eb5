// Calibrations of a PHANToM, as text format or JSON: accepted with every number in its range, or refused with
// a LoadError.

#include <cstdlib>

#include "load/phantom_calibration.h"
#include "tests/fuzz/schema_mutator.h"
#include "tests/fuzz/text_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  const std::string text = fuzz::text_of(data, size);
  try {
    v1::PhantomCalibration message;
    const load::TextSource source = load::parse_message(text, "f", fuzz::syntax_of(text), message);
    const v1::PhantomCalibration checked = load::check_phantom_calibration(message, source);
    if (checked.joint_size() != 3) std::abort();
    for (const auto& joint : checked.joint()) {
      if (joint.encoder() > 7 || (joint.motor() > 7 && checked.max_force() > 0.0)) std::abort();
      if (joint.encoder_bits() < 8 || joint.encoder_bits() > 32) std::abort();
      if (joint.counts_per_radian() == 0.0 || !(joint.min_angle() < joint.max_angle())) std::abort();
      if (checked.max_force() > 0.0 && (joint.largest_word() == 0 || joint.largest_word() > 2047))
        std::abort();
    }
    if (checked.button().register_() > 7 || checked.button().bit() > 31) std::abort();
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
  haptic::v1::PhantomCalibration scratch;
  const std::size_t mutated =
      random() % 4 == 0 ? 0 : haptic::fuzz::mutate_text(scratch, data, size, max_size, random);
  return mutated > 0 ? mutated : LLVMFuzzerMutate(data, size, max_size);
}
