#pragma once
// `hapticctl doctor`: what on this machine keeps devices from being opened, or ticks from being on time, with
// the reason and the command that mends each. It changes nothing, and needs no daemon.

#include <optional>
#include <stdexcept>
#include <string>

#include "client/doctor/finding.h"
#include "client/doctor/machine.h"
#include "haptic/v1/config.pb.h"

namespace haptic::doctor {

/// A config that cannot be read; the message tells file, line and column.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads a config, in text format, or JSON if its name ends in .json, with its paths made absolute. That it
/// says what is permitted is for `hapticd check` to tell. Throws ConfigError.
v1::DaemonConfig read_config(const std::string& path);

/// The config that the daemon which runs was started with, else the system's own, /etc/hapticd/hapticd.txtpb;
/// empty if there is neither.
std::string find_config(const Machine& machine);

/// The whole examination. Without a config what is connected is looked at instead.
Findings examine(const Machine& machine, const std::optional<v1::DaemonConfig>& config);

/// The worst verdict; kOk of none.
Verdict worst(const Findings& findings) noexcept;

}  // namespace haptic::doctor
