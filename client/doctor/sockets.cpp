#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "client/doctor/checks.h"

namespace haptic::doctor {

namespace {

constexpr const char* kServiceSocket = "/run/hapticd/hapticd.sock";

void check_socket(const Machine& machine, const std::string& path, Findings& findings) {
  const std::string about = "socket";
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const bool daemon_runs = !machine.processes("hapticd").empty();
  if (!machine.exists(folder)) {
    findings.push_back({about, Verdict::kBad, folder + ", where the daemon is to listen, is not there",
                        fmt::format("sudo install -d -o {} {}", machine.user().name, folder)});
  } else if (!machine.may(Access::kReadAndWrite, folder) && !machine.exists(path)) {
    findings.push_back(
        {about, Verdict::kBad,
         fmt::format("{} may not make {} ({})", machine.user().name, path, machine.rights(folder)),
         fmt::format("sudo chown {} {}", machine.user().name, folder)});
  } else if (!machine.exists(path)) {
    findings.push_back({about, daemon_runs ? Verdict::kWarning : Verdict::kOk,
                        daemon_runs ? path + " is not there, though a daemon runs: it listens elsewhere"
                                    : path + " will be made when the daemon starts"});
  } else if (!daemon_runs) {
    findings.push_back(
        {about, Verdict::kNote, path + " is there, and no daemon: the next one takes its place"});
  } else {
    findings.push_back({about, Verdict::kOk, fmt::format("{} ({})", path, machine.rights(path))});
  }
}

void check_file(const Machine& machine, const std::string& about, const std::string& path,
                Findings& findings) {
  if (machine.may(Access::kRead, path)) return;
  findings.push_back(
      {about, Verdict::kBad,
       fmt::format("{} {}", path,
                   machine.exists(path) ? "may not be read by " + machine.user().name : "is not there"),
       "hapticctl certificates --help"});
}

}  // namespace

void check_sockets(const Machine& machine, const v1::DaemonConfig& config, Findings& findings) {
  const std::size_t before = findings.size();
  for (const v1::Listen& listen : config.listen()) {
    if (listen.has_unix()) check_socket(machine, listen.unix().path(), findings);
    if (!listen.tcp().has_tls()) continue;
    const v1::Listen::Tls& tls = listen.tcp().tls();
    for (const std::string* file : std::array{&tls.certificate(), &tls.key(), &tls.authority()}) {
      check_file(machine, "tls", *file, findings);
    }
  }
  if (config.listen_size() > 0) {
    if (findings.size() == before)
      findings.push_back({"socket", Verdict::kOk, "it listens as the config says"});
    return;
  }
  if (machine.exists(kServiceSocket)) return check_socket(machine, kServiceSocket, findings);
  findings.push_back(
      {"socket", Verdict::kOk, "the daemon listens at the default place of the user who runs it"});
}

}  // namespace haptic::doctor
