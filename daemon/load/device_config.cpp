#include "load/device_config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "load/ranges.h"
#include "load/read_file.h"
#include "load/scene_parts.h"

namespace haptic::load {

namespace {

const google::protobuf::OneofDescriptor* drivers_of_schema() {
  return v1::Device::descriptor()->FindOneofByName("driver");
}

/// Fills in `fallback` for a field that was left away, and checks what was not.
void number(const TextSource& source, const std::string& field, double value, double fallback,
            const Range& range, auto set) {
  if (value == 0.0) return set(fallback);
  check_range(source, field, value, range);
}

/// Checks the pose and normalises its rotation.
void check_base(const TextSource& source, const std::string& field, v1::Pose& base) {
  const engine::Pose pose = make_pose(source, field, base);
  v1::Quaternion& turn = *base.mutable_orientation();
  turn.set_w(pose.orientation.w);
  turn.set_x(pose.orientation.x);
  turn.set_y(pose.orientation.y);
  turn.set_z(pose.orientation.z);
}

void check_digest(const TextSource& source, const std::string& field, std::string digest,
                  const std::string& bytes) {
  std::transform(digest.begin(), digest.end(), digest.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::size_t kDigits = 64;
  if (digest.size() != kDigits || digest.find_first_not_of("0123456789abcdef") != std::string::npos) {
    source.fail(field, "is no SHA-256: expected 64 hexadecimal digits");
  }
  if (const std::string own = sha256(bytes); digest != own) {
    source.fail(field, "is not that of the file, which has " + own);
  }
}

std::string falcon(const TextSource& source, const std::string& field, const std::filesystem::path& file,
                   v1::Device::Falcon& device) {
  number(source, field + ".gain", device.gain(), 10000.0, {100.0, 1e5, " words/(N m)"},
         [&](double v) { device.set_gain(v); });
  number(source, field + ".max_force", device.max_force(), 4.0, {0.0, 10.0, " N", true},
         [&](double v) { device.set_max_force(v); });
  if (device.firmware().empty()) {
    if (!device.firmware_sha256().empty()) {
      source.fail(field + ".firmware_sha256", "has no file: expected firmware beside it");
    }
    return {};
  }
  device.set_firmware(relative_to(file, device.firmware()).string());
  std::string bytes;
  try {
    bytes = read_file(device.firmware(), kMaxFirmwareBytes);
  } catch (const LoadError& error) {
    source.fail(field + ".firmware", error.what());
  }
  if (bytes.empty()) source.fail(field + ".firmware", device.firmware() + " is empty");
  if (!device.firmware_sha256().empty()) {
    check_digest(source, field + ".firmware_sha256", device.firmware_sha256(), bytes);
  }
  return bytes;
}

}  // namespace

std::string known_drivers() {
  std::string names;
  for (int i = 0; i < drivers_of_schema()->field_count(); ++i) {
    names += (i == 0 ? "" : ", ") + drivers_of_schema()->field(i)->name();
  }
  return names;
}

std::string driver_name(const v1::Device& device) {
  const google::protobuf::FieldDescriptor* const field =
      device.GetReflection()->GetOneofFieldDescriptor(device, drivers_of_schema());
  return field != nullptr ? field->name() : "";
}

std::string check_hardware(const TextSource& source, const std::string& field,
                           const std::filesystem::path& file, v1::Device& device) {
  const bool is_computed = device.has_simulated() || device.has_playback();
  if (is_computed && device.has_base()) {
    source.fail(field + ".base", "is only for hardware: this device follows a path in the world");
  }
  if (device.has_base()) check_base(source, field + ".base", *device.mutable_base());
  if (device.has_falcon()) return falcon(source, field + ".falcon", file, *device.mutable_falcon());
  return {};
}

std::string sha256(const std::string& bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  // fails for lack of memory only; then the digest is of no bytes and fits no file
  (void)EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr);
  std::string text;
  for (unsigned i = 0; i < length; ++i) {
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 15U];
  }
  return text;
}

}  // namespace haptic::load
