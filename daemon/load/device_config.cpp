#include "load/device_config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
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

void spacemouse(const TextSource& source, const std::string& field, v1::Device::Spacemouse& device) {
  number(source, field + ".speed", device.speed(), 0.1, {0.0, 2.0, " m/s", true},
         [&](double v) { device.set_speed(v); });
  number(source, field + ".turn_rate", device.turn_rate(), 1.0, {0.0, 20.0, " rad/s", true},
         [&](double v) { device.set_turn_rate(v); });
  number(source, field + ".reach", device.reach(), 0.2, {0.0, 100.0, " m", true},
         [&](double v) { device.set_reach(v); });
  constexpr std::array<std::string_view, 6> kAxes = {"x", "y", "z", "rx", "ry", "rz"};
  for (int i = 0; i < device.inverted_size(); ++i) {
    if (std::find(kAxes.begin(), kAxes.end(), device.inverted(i)) != kAxes.end()) continue;
    source.fail(item(field + ".inverted", i),
                in_quotes(device.inverted(i)) + " is no axis (permitted: x, y, z, rx, ry, rz)");
  }
}

void require_port(const TextSource& source, const std::string& field, const std::string& port) {
  if (port.empty()) source.fail(field + ".port", "is missing: expected a serial port, e.g. \"/dev/ttyUSB0\"");
}

double most_stations(v1::Device::Fastrak::Model model) {
  if (model == v1::Device::Fastrak::PATRIOT) return 2;
  return model == v1::Device::Fastrak::LIBERTY ? 16 : 4;
}

void fastrak(const TextSource& source, const std::string& field, v1::Device::Fastrak& device) {
  require_port(source, field, device.port());
  if (device.baud() == 0) device.set_baud(115200);
  constexpr std::array<std::uint32_t, 7> kRates = {2400, 4800, 9600, 19200, 38400, 57600, 115200};
  if (std::find(kRates.begin(), kRates.end(), device.baud()) == kRates.end()) {
    source.fail(field + ".baud",
                std::to_string(device.baud()) +
                    " is none of its rates (permitted: 2400, 4800, 9600, 19200, 38400, 57600, 115200)");
  }
  if (device.model() == v1::Device::Fastrak::MODEL_UNSPECIFIED) {
    device.set_model(v1::Device::Fastrak::FASTRAK);
  }
  if (device.station() == 0) device.set_station(1);
  check_range(source, field + ".station", device.station(), {1, most_stations(device.model())});
  if (!device.has_hemisphere()) device.mutable_hemisphere()->set_x(1.0);
  const glm::dvec3 hemisphere = make_point(source, field + ".hemisphere", device.hemisphere());
  if (hemisphere == glm::dvec3(0.0)) source.fail(field + ".hemisphere", "points nowhere");
}

void polhem(const TextSource& source, const std::string& field, v1::Device::Polhem& device) {
  using Polhem = v1::Device::Polhem;
  if (device.model() == Polhem::MODEL_UNSPECIFIED) {
    source.fail(field + ".model",
                "is missing (permitted: WOODENHAPTICS_2019, WOODENHAPTICS_2015, ALUHAPTICS_V2, VINTAGE)");
  }
  number(source, field + ".max_current", device.max_current(), 2.0, {0.0, 6.0, " A", true},
         [&](double v) { device.set_max_current(v); });
  number(source, field + ".max_force", device.max_force(), 5.0, {0.0, 20.0, " N", true},
         [&](double v) { device.set_max_force(v); });
  if (device.has_udp()) {
    if (device.udp().port() == 0) device.mutable_udp()->set_port(47111);
    check_range(source, field + ".udp.port", device.udp().port(), {1, 65535});
  } else {
    Polhem::Usb& usb = *device.mutable_usb();
    if (usb.vendor() == 0) usb.set_vendor(0x16c0);
    if (usb.product() == 0) usb.set_product(0x0486);
    check_range(source, field + ".usb.vendor", usb.vendor(), {1, 65535});
    check_range(source, field + ".usb.product", usb.product(), {1, 65535});
  }
  if (device.rest_counts_size() == 0 && device.model() == Polhem::WOODENHAPTICS_2019) {
    for (const int count : {0, 0, 6000}) device.add_rest_counts(count);
  }
  if (device.rest_counts_size() != 3) {
    source.fail(field + ".rest_counts", "has " + std::to_string(device.rest_counts_size()) +
                                            " numbers: expected one for each of three encoders");
  }
  for (int i = 0; i < 3; ++i) {
    check_range(source, item(field + ".rest_counts", i), device.rest_counts(i), {-32768, 32767});
  }
}

void haply(const TextSource& source, const std::string& field, v1::Device::Haply& device) {
  require_port(source, field, device.port());
  if (device.model() == v1::Device::Haply::MODEL_UNSPECIFIED) {
    device.set_model(v1::Device::Haply::HARDWARE_3);
  }
  check_range(source, field + ".max_force", device.max_force(), {0.0, 5.0, " N"});
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
  const bool is_in_world = device.has_simulated() || device.has_playback() || device.has_virtual_();
  if (is_in_world && device.has_base()) {
    source.fail(field + ".base", "is only for hardware: this device is told where it is in the world");
  }
  if (device.has_base()) check_base(source, field + ".base", *device.mutable_base());
  switch (device.driver_case()) {
    case v1::Device::kFalcon:
      return falcon(source, field + ".falcon", file, *device.mutable_falcon());
    case v1::Device::kSpacemouse:
      spacemouse(source, field + ".spacemouse", *device.mutable_spacemouse());
      break;
    case v1::Device::kHydra:
      check_range(source, field + ".hydra.wand", device.hydra().wand(), {0, 1});
      break;
    case v1::Device::kFastrak:
      fastrak(source, field + ".fastrak", *device.mutable_fastrak());
      break;
    case v1::Device::kPolhem:
      polhem(source, field + ".polhem", *device.mutable_polhem());
      break;
    case v1::Device::kHaply:
      haply(source, field + ".haply", *device.mutable_haply());
      break;
    default:
      break;
  }
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
