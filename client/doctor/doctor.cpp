#include "client/doctor/doctor.h"

#include <fmt/format.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "client/doctor/checks.h"

namespace haptic::doctor {

namespace {

constexpr const char* kSystemConfig = "/etc/hapticd/hapticd.txtpb";

class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, google::protobuf::io::ColumnNumber column, const std::string& message) override {
    if (text.empty()) text = fmt::format("{}:{}: {}", line + 1, column + 1, message);
  }
  std::string text;
};

void make_absolute(const std::filesystem::path& folder, std::string& path) {
  if (!path.empty()) path = (folder / path).lexically_normal().string();
}

void make_absolute(const std::filesystem::path& folder, v1::DaemonConfig& config) {
  for (v1::Listen& listen : *config.mutable_listen()) {
    if (listen.has_unix()) make_absolute(folder, *listen.mutable_unix()->mutable_path());
    if (!listen.tcp().has_tls()) continue;
    v1::Listen::Tls& tls = *listen.mutable_tcp()->mutable_tls();
    make_absolute(folder, *tls.mutable_certificate());
    make_absolute(folder, *tls.mutable_key());
    make_absolute(folder, *tls.mutable_authority());
  }
  for (v1::Device& device : *config.mutable_device()) {
    if (device.has_falcon()) make_absolute(folder, *device.mutable_falcon()->mutable_firmware());
    if (device.has_phantom()) make_absolute(folder, *device.mutable_phantom()->mutable_calibration());
    if (device.has_external()) make_absolute(folder, *device.mutable_external()->mutable_path());
    if (device.has_playback()) make_absolute(folder, *device.mutable_playback()->mutable_path());
    if (device.simulated().has_hand()) {
      make_absolute(folder, *device.mutable_simulated()->mutable_hand()->mutable_path());
    }
  }
}

}  // namespace

const char* name_of(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kOk:
      return "OK";
    case Verdict::kNote:
      return "NOTE";
    case Verdict::kWarning:
      return "WARNING";
    default:
      return "BAD";
  }
}

v1::DaemonConfig read_config(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path)) throw ConfigError(path + ": cannot be read");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  v1::DaemonConfig config;
  if (path.ends_with(".json")) {
    const auto status = google::protobuf::util::JsonStringToMessage(text, &config);
    if (!status.ok()) throw ConfigError(path + ": " + std::string(status.message()));
  } else {
    FirstError error;
    google::protobuf::TextFormat::Parser parser;
    parser.RecordErrorsTo(&error);
    if (!parser.ParseFromString(text, &config)) throw ConfigError(path + ":" + error.text);
  }
  make_absolute(std::filesystem::absolute(path).parent_path(), config);
  return config;
}

std::string find_config(const Machine& machine) {
  for (const int pid : machine.processes("hapticd")) {
    const std::string folder = "/proc/" + std::to_string(pid);
    std::istringstream words(machine.text(folder + "/cmdline").value_or(""));
    std::string before;
    for (std::string word; std::getline(words, word, '\0'); before = word) {
      std::string file = before == "--config" ? word : "";
      if (word.starts_with("--config=")) file = word.substr(9);
      if (file.empty()) continue;
      return (std::filesystem::path(machine.link(folder + "/cwd").value_or("/")) / file)
          .lexically_normal()
          .string();
    }
  }
  return machine.exists(kSystemConfig) ? kSystemConfig : "";
}

Findings examine(const Machine& machine, const std::optional<v1::DaemonConfig>& config) {
  Findings findings;
  const v1::DaemonConfig looked_at = config.value_or(v1::DaemonConfig());
  check_real_time(machine, looked_at.servo(), findings);
  if (config) {
    for (const v1::Device& device : looked_at.device()) check_device(machine, device, findings);
  } else {
    check_connected(machine, findings);
  }
  check_sockets(machine, looked_at, findings);
  return findings;
}

Verdict worst(const Findings& findings) noexcept {
  Verdict worst = Verdict::kOk;
  for (const Finding& finding : findings) worst = std::max(worst, finding.verdict);
  return worst;
}

}  // namespace haptic::doctor
