#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>

#include "client/cli/verbs.h"
#include "client/doctor/doctor.h"

namespace haptic::cli {
namespace {

using doctor::Finding;
using doctor::Findings;
using doctor::Verdict;

constexpr const char* kServiceUser = "hapticd";
constexpr std::chrono::milliseconds kPatience{2000};

struct DoctorOptions {
  std::string config;
  std::string user;
};

doctor::User this_user() {
  doctor::User user;
  user.uid = ::geteuid();
  const passwd* const entry = ::getpwuid(user.uid);
  user.name = entry != nullptr ? entry->pw_name : std::to_string(user.uid);
  std::array<gid_t, 256> groups{};
  const int count = ::getgroups(static_cast<int>(groups.size()), groups.data());
  user.groups.assign(groups.begin(), groups.begin() + std::max(count, 0));
  user.groups.push_back(::getegid());
  return user;
}

/// The one named, else the service's if there is one, else whoever asks.
std::optional<doctor::User> user_of(const DoctorOptions& options) {
  if (!options.user.empty()) return doctor::find_user("/", options.user);
  const std::optional<doctor::User> service = doctor::find_user("/", kServiceUser);
  return service ? service : this_user();
}

/// What a daemon that runs tells of itself.
void ask_daemon(const Command& command, Findings& findings) {
  const std::string own = HAPTIC_VERSION;
  try {
    client::Connection& daemon = command.connect(kPatience);
    const v1::Response status = call(daemon, [](v1::Request& request) { request.mutable_get_status(); });
    const bool is_same = status.status().version() == own;
    findings.push_back({"versions", is_same ? Verdict::kOk : Verdict::kNote,
                        fmt::format("hapticd {}, hapticctl {}", status.status().version(), own)});
    for (const std::string& warning : status.status().real_time().warning()) {
      findings.push_back({"daemon", Verdict::kWarning, warning});
    }
    const v1::Response devices = call(daemon, [](v1::Request& request) { request.mutable_list_devices(); });
    for (const v1::DeviceStatus& device : devices.devices().device()) {
      if (device.present()) continue;
      const std::string reason = device.reason().empty() ? "" : ": " + device.reason();
      findings.push_back({"device " + device.description().name(), Verdict::kWarning,
                          "the daemon has no sample of it" + reason, "hapticctl devices"});
    }
  } catch (const client::ProtocolMismatch& error) {
    findings.push_back({"versions", Verdict::kBad, fmt::format("hapticctl {}: {}", own, error.what())});
  } catch (const client::Error& error) {
    findings.push_back(
        {"versions", Verdict::kNote, fmt::format("hapticctl {}; no daemon answers: {}", own, error.what())});
  }
}

void print_as_json(const Finding& finding) {
  google::protobuf::Struct message;
  auto& fields = *message.mutable_fields();
  fields["about"].set_string_value(finding.about);
  fields["verdict"].set_string_value(doctor::name_of(finding.verdict));
  fields["reason"].set_string_value(finding.reason);
  fields["command"].set_string_value(finding.command);
  print_json(message);
}

void print_text(const Findings& findings) {
  for (const Finding& finding : findings) {
    fmt::print("{:<8} {:<12} {}\n", doctor::name_of(finding.verdict), finding.about, finding.reason);
    if (!finding.command.empty()) {
      fmt::print("{:<22}$ {}\n", "", finding.command);
    }
  }
}

ExitCode complain(const std::string& message) {
  fmt::print(stderr, "hapticctl: {}\n", message);
  return kFailed;
}

ExitCode examine(const Command& command, const DoctorOptions& options) {
  const std::optional<doctor::User> user = user_of(options);
  if (!user) {
    return complain("there is no user " + options.user);
  }
  const doctor::Machine machine("/", *user, user->uid == ::geteuid());
  const std::string file = options.config.empty() ? doctor::find_config(machine) : options.config;
  Findings findings;
  try {
    std::optional<v1::DaemonConfig> config;
    if (!file.empty()) {
      config = doctor::read_config(file);
    }
    findings.push_back({"user", Verdict::kOk, "looked at for the user " + user->name});
    findings.push_back({"config", file.empty() ? Verdict::kNote : Verdict::kOk,
                        file.empty() ? "none: --config names the daemon's, and what it needs" : file});
    const Findings found = doctor::examine(machine, config);
    findings.insert(findings.end(), found.begin(), found.end());
  } catch (const doctor::ConfigError& error) {
    return complain(error.what());
  }
  ask_daemon(command, findings);
  if (command.json) {
    for (const Finding& finding : findings) {
      print_as_json(finding);
    }
  } else {
    print_text(findings);
  }
  return doctor::worst(findings) == Verdict::kBad ? kFailed : kDone;
}

}  // namespace

void add_doctor(CLI::App& app, Command& command) {
  const auto options = std::make_shared<DoctorOptions>();
  CLI::App& verb =
      add_verb(app, command, "doctor",
               "explain what keeps devices from being opened or ticks from being on time, and how to mend it",
               [options](const Command& chosen) { return examine(chosen, *options); });
  add_option(verb, "--config", options->config,
             "the daemon's config; default: of the daemon that runs, else /etc/hapticd/hapticd.txtpb")
      .type("FILE");
  add_option(verb, "--user", options->user,
             "who runs the daemon; default: hapticd if there is such a user, else you")
      .type("NAME");
}

}  // namespace haptic::cli
