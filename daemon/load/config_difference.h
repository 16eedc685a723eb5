#pragma once
// What has changed between two configs, and whether a daemon that runs can take it over.
//
//     limits, drive, who may come in through a listener, its certificates    while it runs
//     everything else                                                        by a restart

#include <string>
#include <vector>

#include "haptic/v1/config.pb.h"

namespace haptic::load {

/// Paths of the fields, as "listen[0].unix.allow[1].role"; a message or an entry of a list that is in one of
/// the two only is told as a whole.
struct ConfigDifference {
  std::vector<std::string> taken_over;
  std::vector<std::string> needs_restart;
};

ConfigDifference compare(const v1::DaemonConfig& running, const v1::DaemonConfig& wanted);

/// The config that runs after a reload: `running` with what can be taken over of `wanted`.
v1::DaemonConfig after_reload(const v1::DaemonConfig& running, const v1::DaemonConfig& wanted);

}  // namespace haptic::load
