#include "drivers/registry.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "drivers/external/external_device.h"
#include "drivers/falcon/falcon_device.h"
#include "drivers/fastrak/fastrak_device.h"
#include "drivers/haply/haply_device.h"
#include "drivers/hydra/hydra_device.h"
#include "drivers/phantom/phantom_device.h"
#include "drivers/playback/playback_device.h"
#include "drivers/polhem/polhem_device.h"
#include "drivers/simulated/simulated_device.h"
#include "drivers/spacemouse/spacemouse_device.h"
#include "drivers/virtual/virtual_device.h"
#include "haptic/v1/calibration.pb.h"

namespace haptic::drivers {

namespace {

/// What the files hold that a config names.
struct Files {
  std::vector<PathPoint> path;
  const std::string& firmware;
  const v1::PhantomCalibration* calibration;
};

struct Driver {
  v1::Device::DriverCase driver;
  std::string (*path_file)(const v1::Device& config);  // none: it lives in real time, and follows no path
  std::unique_ptr<Device> (*make)(const v1::Device& config, const Files& files);
};

BasePose base_of(const v1::Device& config) {
  if (!config.has_base()) return {};
  const v1::Vector3& position = config.base().position();
  const v1::Quaternion& turn = config.base().orientation();
  return {.position = {position.x(), position.y(), position.z()},
          .orientation = {turn.w(), turn.x(), turn.y(), turn.z()}};
}

InjectedKind kind_of(v1::Device::Simulated::InjectedFault::Kind kind) {
  using Fault = v1::Device::Simulated::InjectedFault;
  switch (kind) {
    case Fault::DELAY:
      return InjectedKind::kDelay;
    case Fault::FREEZE:
      return InjectedKind::kFreeze;
    case Fault::NOT_A_NUMBER:
      return InjectedKind::kNotANumber;
    case Fault::JUMP:
      return InjectedKind::kJump;
    case Fault::UNPLUG:
      return InjectedKind::kUnplug;
    default:
      return InjectedKind::kDrop;
  }
}

std::vector<InjectedFault> faults_of(const v1::Device::Simulated& config) {
  std::vector<InjectedFault> faults;
  faults.reserve(static_cast<std::size_t>(config.fault_size()));
  for (const auto& fault : config.fault()) {
    const v1::Vector3& offset = fault.offset();
    faults.push_back(
        {.kind = kind_of(fault.kind()),
         .at = fault.at(),
         .duration = fault.duration() == 0.0 ? std::numeric_limits<double>::infinity() : fault.duration(),
         .delay = fault.delay(),
         .offset = {offset.x(), offset.y(), offset.z()}});
  }
  return faults;
}

std::unique_ptr<Device> make_simulated(const v1::Device& config, const Files& files) {
  const v1::Device::Simulated& simulated = config.simulated();
  SimulatedSettings settings{.name = config.name(),
                             .mass = simulated.mass(),
                             .damping = simulated.damping(),
                             .hand_stiffness = simulated.hand().stiffness(),
                             .hand_damping = simulated.hand().damping(),
                             .path = files.path,
                             .repeat = simulated.hand().repeat(),
                             .faults = faults_of(simulated)};
  return std::make_unique<SimulatedDevice>(std::move(settings));
}

std::unique_ptr<Device> make_playback(const v1::Device& config, const Files& files) {
  return std::make_unique<PlaybackDevice>(config.name(), files.path, config.playback().repeat());
}

std::unique_ptr<Device> make_falcon(const v1::Device& config, const Files& files) {
  const v1::Device::Falcon& falcon = config.falcon();
  return falcon::make_falcon({.name = config.name(),
                              .serial = falcon.serial(),
                              .firmware = {files.firmware.begin(), files.firmware.end()},
                              .world_from_base = base_of(config),
                              .control = {.gain = falcon.gain(), .max_force = falcon.max_force()}});
}

std::unique_ptr<Device> make_spacemouse(const v1::Device& config, const Files& /*files*/) {
  const v1::Device::Spacemouse& spacemouse = config.spacemouse();
  const auto sign = [&](const char* axis) {
    const auto& inverted = spacemouse.inverted();
    return std::find(inverted.begin(), inverted.end(), axis) == inverted.end() ? 1.0 : -1.0;
  };
  return spacemouse::make_spacemouse({.name = config.name(),
                                      .serial = spacemouse.serial(),
                                      .world_from_base = base_of(config),
                                      .motion = {.speed = spacemouse.speed(),
                                                 .turn_rate = spacemouse.turn_rate(),
                                                 .reach = spacemouse.reach(),
                                                 .translation_signs = {sign("x"), sign("y"), sign("z")},
                                                 .rotation_signs = {sign("rx"), sign("ry"), sign("rz")}}});
}

std::unique_ptr<Device> make_hydra(const v1::Device& config, const Files& /*files*/) {
  return hydra::make_hydra(
      {.name = config.name(), .wand = config.hydra().wand(), .world_from_base = base_of(config)});
}

fastrak::Model fastrak_model(v1::Device::Fastrak::Model model) {
  switch (model) {
    case v1::Device::Fastrak::LIBERTY:
      return fastrak::Model::kLiberty;
    case v1::Device::Fastrak::PATRIOT:
      return fastrak::Model::kPatriot;
    default:
      return fastrak::Model::kFastrak;
  }
}

std::unique_ptr<Device> make_fastrak(const v1::Device& config, const Files& /*files*/) {
  const v1::Device::Fastrak& fastrak = config.fastrak();
  const v1::Vector3& towards = fastrak.hemisphere();
  return fastrak::make_fastrak(
      {.name = config.name(),
       .line = {.port = fastrak.port(), .baud = fastrak.baud(), .model = fastrak_model(fastrak.model())},
       .station = {.number = static_cast<int>(fastrak.station()),
                   .hemisphere = {towards.x(), towards.y(), towards.z()}},
       .world_from_base = base_of(config)});
}

const polhem::Model& polhem_model(v1::Device::Polhem::Model model) {
  switch (model) {
    case v1::Device::Polhem::WOODENHAPTICS_2015:
      return polhem::kWoodenhaptics2015;
    case v1::Device::Polhem::ALUHAPTICS_V2:
      return polhem::kAluhapticsV2;
    case v1::Device::Polhem::VINTAGE:
      return polhem::kVintage;
    default:
      return polhem::kWoodenhaptics2019;
  }
}

std::unique_ptr<Device> make_polhem(const v1::Device& config, const Files& /*files*/) {
  const v1::Device::Polhem& polhem = config.polhem();
  polhem::Joints rest{};
  for (int i = 0; i < std::min<int>(polhem.rest_counts_size(), 3); ++i) {
    rest[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(polhem.rest_counts(i));
  }
  return polhem::make_polhem({.name = config.name(),
                              .vendor = static_cast<std::uint16_t>(polhem.usb().vendor()),
                              .product = static_cast<std::uint16_t>(polhem.usb().product()),
                              .udp_port = static_cast<std::uint16_t>(polhem.udp().port()),
                              .world_from_base = base_of(config),
                              .control = {.model = polhem_model(polhem.model()),
                                          .rest_counts = rest,
                                          .calibrate_at_start = polhem.calibrate_at_start(),
                                          .max_current = polhem.max_current(),
                                          .max_force = polhem.max_force()}});
}

std::unique_ptr<Device> make_haply(const v1::Device& config, const Files& /*files*/) {
  const bool is_hardware_2 = config.haply().model() == v1::Device::Haply::HARDWARE_2;
  return haply::make_haply({.name = config.name(),
                            .port = config.haply().port(),
                            .wiring = is_hardware_2 ? haply::kWiring2 : haply::kWiring3,
                            .geometry = is_hardware_2 ? haply::kGeometry2 : haply::kGeometry3,
                            .max_force = config.haply().max_force(),
                            .world_from_base = base_of(config)});
}

phantom::Reference reference_of(v1::PhantomCalibration::Reference reference) {
  switch (reference) {
    case v1::PhantomCalibration::REST_AT_START:
      return phantom::Reference::kRestAtStart;
    case v1::PhantomCalibration::COUNTS_ARE_KEPT:
      return phantom::Reference::kCountsAreKept;
    default:
      return phantom::Reference::kRestAtButton;
  }
}

phantom::Calibration calibration_of(const v1::PhantomCalibration& message) {
  phantom::Calibration calibration{
      .geometry = {.upper_arm = message.upper_arm(), .forearm = message.forearm()},
      .reference = reference_of(message.reference())};
  for (int i = 0; i < std::min<int>(message.joint_size(), 3); ++i) {
    const v1::PhantomCalibration::Joint& joint = message.joint(i);
    const auto index = static_cast<std::size_t>(i);
    calibration.map.encoders[index] = joint.encoder();
    calibration.map.encoder_bits[index] = joint.encoder_bits();
    calibration.map.motors[index] = joint.motor();
    calibration.map.largest_words[index] = joint.largest_word();
    calibration.counts_per_radian[index] = joint.counts_per_radian();
    calibration.rest_counts[index] = joint.rest_count();
    calibration.rest_angles[i] = joint.rest_angle();
    calibration.least_angles[i] = joint.min_angle();
    calibration.greatest_angles[i] = joint.max_angle();
    calibration.words_per_torque[i] = joint.words_per_newton_metre();
  }
  if (message.has_button()) {
    calibration.map.button = phantom::Button{.index = message.button().register_(),
                                             .bit = message.button().bit(),
                                             .is_low = message.button().is_low()};
  }
  return calibration;
}

std::unique_ptr<Device> make_phantom(const v1::Device& config, const Files& files) {
  phantom::PhantomSettings settings{.name = config.name(),
                                    .path = config.phantom().path(),
                                    .max_force = config.phantom().max_force(),
                                    .world_from_base = base_of(config)};
  if (files.calibration != nullptr) settings.calibration = calibration_of(*files.calibration);
  return phantom::make_phantom(std::move(settings));
}

std::unique_ptr<Device> make_virtual(const v1::Device& config, const Files& /*files*/) {
  return std::make_unique<VirtualDevice>(config.name());
}

std::unique_ptr<Device> make_external(const v1::Device& config, const Files& /*files*/) {
  const v1::Device::External& settings = config.external();
  const bool is_limited = settings.max_force() != 0.0;
  return external::make_external(
      {.name = config.name(),
       .path = settings.path(),
       .users = {settings.user().begin(), settings.user().end()},
       .max_force = is_limited ? settings.max_force() : std::numeric_limits<double>::infinity(),
       .world_from_base = base_of(config)});
}

constexpr Driver kDrivers[] = {
    {v1::Device::kSimulated, [](const v1::Device& config) { return config.simulated().hand().path(); },
     &make_simulated},
    {v1::Device::kPlayback, [](const v1::Device& config) { return config.playback().path(); },
     &make_playback},
    {v1::Device::kFalcon, nullptr, &make_falcon},
    {v1::Device::kSpacemouse, nullptr, &make_spacemouse},
    {v1::Device::kHydra, nullptr, &make_hydra},
    {v1::Device::kFastrak, nullptr, &make_fastrak},
    {v1::Device::kPolhem, nullptr, &make_polhem},
    {v1::Device::kHaply, nullptr, &make_haply},
    {v1::Device::kVirtual, nullptr, &make_virtual},
    {v1::Device::kExternal, nullptr, &make_external},
    {v1::Device::kPhantom, nullptr, &make_phantom},
};

const Driver* find_driver(const v1::Device& config) {
  for (const Driver& row : kDrivers) {
    if (row.driver == config.driver_case()) return &row;
  }
  return nullptr;
}

}  // namespace

std::string path_file_of(const v1::Device& config) {
  const Driver* const driver = find_driver(config);
  return driver != nullptr && driver->path_file != nullptr ? driver->path_file(config) : std::string();
}

bool is_computed(const v1::Device& config) {
  const Driver* const driver = find_driver(config);
  return driver != nullptr && driver->path_file != nullptr;
}

std::unique_ptr<Device> make_device(const v1::Device& config, std::vector<PathPoint> path,
                                    const std::string& firmware, const v1::PhantomCalibration* calibration) {
  const Driver* const driver = find_driver(config);
  if (driver == nullptr) {
    throw DeviceError("device \"" + config.name() + "\": it names no driver");
  }
  return driver->make(config, {std::move(path), firmware, calibration});
}

}  // namespace haptic::drivers
