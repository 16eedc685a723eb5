#include "load/phantom_calibration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "load/ranges.h"
#include "load/read_file.h"

namespace haptic::load {

namespace {

using Calibration = v1::PhantomCalibration;

constexpr Range kRegisters{0, 7};
constexpr Range kAngles{-3.2, 3.2, " rad"};
constexpr double kDefaultAngle = 1.5;   // rad
constexpr double kLargestForce = 40.0;  // N; the strongest model is told to reach 37.5

/// Each of its own, so that two joints do not share one.
class Taken {
 public:
  explicit Taken(const TextSource& source) : source_(source) {}

  void add(const std::string& field, std::uint32_t index) {
    const auto [same, is_new] = fields_.emplace(index, field);
    if (!is_new) {
      source_.fail(field, std::to_string(index) + " is also that of " + same->second);
    }
  }

 private:
  const TextSource& source_;
  std::map<std::uint32_t, std::string> fields_;
};

void check_not_zero(const TextSource& source, const std::string& field, double value, double most,
                    const char* unit) {
  if (value == 0.0)
    source.fail(field, "is missing: a number from " + to_text(-most) + " to " + to_text(most));
  check_range(source, field, value, {-most, most, unit});
}

void encoder(const TextSource& source, const std::string& field, Calibration::Joint& joint) {
  check_range(source, field + ".encoder", joint.encoder(), kRegisters);
  if (joint.encoder_bits() == 0) joint.set_encoder_bits(16);
  check_range(source, field + ".encoder_bits", joint.encoder_bits(), {8, 32});
  check_not_zero(source, field + ".counts_per_radian", joint.counts_per_radian(), 1e6, "");
  check_range(source, field + ".rest_angle", joint.rest_angle(), kAngles);
  if (joint.min_angle() == 0.0 && joint.max_angle() == 0.0) {
    joint.set_min_angle(-kDefaultAngle);
    joint.set_max_angle(kDefaultAngle);
  }
  check_range(source, field + ".min_angle", joint.min_angle(), kAngles);
  check_range(source, field + ".max_angle", joint.max_angle(), kAngles);
  if (joint.min_angle() >= joint.max_angle()) {
    source.fail(field + ".max_angle",
                to_text(joint.max_angle()) + " is not above min_angle, " + to_text(joint.min_angle()));
  }
  // a counter that can wrap within the range, or up to it from the rest pose, does not tell where the arm is
  const double low = std::min(joint.min_angle(), joint.rest_angle());
  const double high = std::max(joint.max_angle(), joint.rest_angle());
  const double counts = (high - low) * std::abs(joint.counts_per_radian());
  const double most = std::ldexp(1.0, static_cast<int>(joint.encoder_bits()) - 1);
  if (counts >= most) {
    source.fail(field + ".encoder_bits", "hold " + to_text(most) +
                                             " counts to either side, and the angles take " +
                                             to_text(std::ceil(counts)));
  }
}

void motor(const TextSource& source, const std::string& field, Calibration::Joint& joint) {
  check_range(source, field + ".motor", joint.motor(), kRegisters);
  check_not_zero(source, field + ".words_per_newton_metre", joint.words_per_newton_metre(), 1e6, "");
  if (joint.largest_word() == 0) joint.set_largest_word(1024);
  check_range(source, field + ".largest_word", joint.largest_word(), {1, 2047});
}

void reference(const TextSource& source, const Calibration& message) {
  if (message.reference() <= Calibration::REFERENCE_UNSPECIFIED ||
      message.reference() > Calibration::Reference_MAX) {
    source.fail("reference", "is missing (permitted: REST_AT_START, REST_AT_BUTTON, COUNTS_ARE_KEPT)");
  }
  if (message.reference() == Calibration::REST_AT_BUTTON && !message.has_button()) {
    source.fail("button", "is missing: reference is REST_AT_BUTTON");
  }
  for (int i = 0; i < message.joint_size(); ++i) {
    if (message.reference() == Calibration::COUNTS_ARE_KEPT || message.joint(i).rest_count() == 0) continue;
    source.fail(item("joint", i) + ".rest_count", "is only for COUNTS_ARE_KEPT");
  }
}

void button(const TextSource& source, Calibration::Button& button) {
  if (!button.has_register_()) button.set_register_(6);
  if (!button.has_bit()) button.set_bit(1);
  check_range(source, "button.register", button.register_(), kRegisters);
  check_range(source, "button.bit", button.bit(), {0, 31});
}

}  // namespace

v1::PhantomCalibration load_phantom_calibration(const std::filesystem::path& file) {
  v1::PhantomCalibration message;
  const TextSource source = read_message(file, message);
  return check_phantom_calibration(std::move(message), source);
}

v1::PhantomCalibration check_phantom_calibration(v1::PhantomCalibration message, const TextSource& source) {
  check_values(message, source);
  check_range(source, "upper_arm", message.upper_arm(), {0.01, 2.0, " m"});
  check_range(source, "forearm", message.forearm(), {0.01, 2.0, " m"});
  check_range(source, "max_force", message.max_force(), {0.0, kLargestForce, " N"});
  if (message.joint_size() != 3) {
    source.fail("joint", "there are " + std::to_string(message.joint_size()) +
                             ": expected three, of base, upper arm and forearm");
  }
  Taken encoders(source);
  Taken motors(source);
  for (int i = 0; i < message.joint_size(); ++i) {
    const std::string field = item("joint", i);
    encoder(source, field, *message.mutable_joint(i));
    encoders.add(field + ".encoder", message.joint(i).encoder());
    if (message.max_force() == 0.0) continue;  // motors are never written to
    motor(source, field, *message.mutable_joint(i));
    motors.add(field + ".motor", message.joint(i).motor());
  }
  reference(source, message);
  if (message.has_button()) button(source, *message.mutable_button());
  return message;
}

std::shared_ptr<const v1::PhantomCalibration> check_phantom(const TextSource& source,
                                                            const std::string& field,
                                                            const std::filesystem::path& file,
                                                            v1::Device& device) {
  if (!device.has_phantom()) return nullptr;
  v1::Device::Phantom& phantom = *device.mutable_phantom();
  const std::string at = field + ".phantom";
  if (phantom.path().empty()) {
    source.fail(at + ".path", "is missing: expected the card's node, e.g. \"/dev/phantom0\"");
  }
  check_range(source, at + ".max_force", phantom.max_force(), {0.0, kLargestForce, " N"});
  if (phantom.calibration().empty()) {
    if (phantom.max_force() != 0.0)
      source.fail(at + ".max_force", "needs a calibration: there is no force without");
    return nullptr;
  }
  phantom.set_calibration(relative_to(file, phantom.calibration()).string());
  auto calibration = std::make_shared<v1::PhantomCalibration>();
  try {
    *calibration = load_phantom_calibration(phantom.calibration());
  } catch (const LoadError& error) {
    // a file that is wrong tells so itself; one that cannot be read is an error of the field
    if (error.line() != 0 || !error.field().empty()) throw;
    source.fail(at + ".calibration", error.what());
  }
  if (phantom.max_force() > calibration->max_force()) {
    source.fail(at + ".max_force", to_text(phantom.max_force()) + " N is more than the calibration allows, " +
                                       to_text(calibration->max_force()) + " N");
  }
  if (phantom.max_force() == 0.0) phantom.set_max_force(calibration->max_force());
  return calibration;
}

}  // namespace haptic::load
