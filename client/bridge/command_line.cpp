#include "client/bridge/command_line.h"

#include <unistd.h>

#include <algorithm>
#include <map>

#include "client/bridge/subject.h"

namespace haptic::bridge {
namespace {

constexpr const char* kUsualUrl = "nats://127.0.0.1:4222";
constexpr std::size_t kLeastBuffer = std::size_t{64} * 1024;
constexpr std::size_t kMostBuffer = std::size_t{1024} * 1024 * 1024;
constexpr std::chrono::milliseconds kDaemonTimeout{3'000};

CLI::Validator existing_file() { return CLI::Validator(CLI::ExistingFile).description(""); }

std::string own_host() {
  char name[256] = "";
  ::gethostname(name, sizeof(name) - 1);
  return *name == '\0' ? "localhost" : name;
}

void add_daemon_options(CLI::App& app, client::Options& daemon) {
  app.add_option("--socket", daemon.address, "the daemon's socket: a path, or host:port")
      ->type_name("ADDRESS");
  app.add_option("--certificate", daemon.identity.certificate, "for TLS with the daemon: your certificate")
      ->envname("HAPTICD_CERTIFICATE")
      ->check(existing_file())
      ->type_name("FILE");
  app.add_option("--key", daemon.identity.key, "for TLS with the daemon: its key")
      ->envname("HAPTICD_KEY")
      ->check(existing_file())
      ->type_name("FILE");
  app.add_option("--authority", daemon.identity.authority,
                 "for TLS with the daemon: who must have signed its certificate")
      ->envname("HAPTICD_AUTHORITY")
      ->check(existing_file())
      ->type_name("FILE");
}

void add_broker_options(CLI::App& app, BrokerOptions& broker) {
  const CLI::Validator url(
      [](const std::string& text) {
        const std::string problem = url_problem(text);
        return problem.empty() ? std::string()
                               : "\"" + without_secrets(text) + "\" is no URL of a broker: " + problem;
      },
      "");
  app.add_option(
         "--url", broker.urls,
         "the broker, nats://HOST:PORT or tls://HOST:PORT; repeatable, the first that answers is used; "
         "default: nats://127.0.0.1:4222")
      ->check(url)
      ->type_name("URL");
  app.add_option("--broker-credentials", broker.credentials, "credentials of a user of the broker (.creds)")
      ->check(existing_file())
      ->type_name("FILE");
  CLI::Option* const certificate =
      app.add_option("--broker-certificate", broker.certificate, "for TLS with the broker: your certificate")
          ->check(existing_file())
          ->type_name("FILE");
  CLI::Option* const key = app.add_option("--broker-key", broker.key, "for TLS with the broker: its key")
                               ->check(existing_file())
                               ->type_name("FILE");
  certificate->needs(key);
  key->needs(certificate);
  app.add_option("--broker-authority", broker.authority,
                 "for TLS with the broker: who must have signed its certificate; default: whom this machine "
                 "trusts")
      ->check(existing_file())
      ->type_name("FILE");
}

void add_stream_options(CLI::App& app, Choice& choice) {
  Options& options = choice.options;
  app.add_option("--host", options.host, "name of this machine in the subjects; default: the host's name")
      ->check(CLI::Validator(
          [](const std::string& text) {
            return text.empty() || text.size() > kHostLimit ? "a host has 1 to 253 characters"
                                                            : std::string();
          },
          ""))
      ->type_name("NAME");
  const std::map<std::string, v1::Topic> topics = {{"objects", v1::OBJECTS}, {"hips", v1::HIPS},
                                                   {"devices", v1::DEVICES}, {"events", v1::EVENTS},
                                                   {"stats", v1::STATS},     {"inputs", v1::INPUTS}};
  app.add_option("--topic", options.topics, "objects, hips, devices, events, stats; default: all of them")
      ->transform(CLI::CheckedTransformer(topics, CLI::ignore_case).description(""))
      ->type_name("TOPIC")
      ->delimiter(',');
  app.add_option("--decimation", options.decimation,
                 "one frame for so many ticks; 1: each. Events and statistics come as they are; default: 20")
      ->check(CLI::Range(1U, 1'000'000U).description(""))
      ->type_name("TICKS");
  CLI::Option* const latest =
      app.add_flag("--latest", choice.latest,
                   "while the broker is slow or away a newer frame replaces an older one (default)");
  app.add_flag("--lossless", choice.lossless,
               "while the broker is slow or away frames wait, as many as --buffer holds")
      ->excludes(latest);
  app.add_option(
         "--buffer", options.buffer,
         "bytes of frames that wait in each topic, with a unit if you like (64 MiB); beyond it the oldest "
         "go; default: 8 MiB")
      ->transform(CLI::AsSizeValue(false).description(""))
      ->check(CLI::Range(kLeastBuffer, kMostBuffer).description(""))
      ->type_name("BYTES");
}

}  // namespace

std::unique_ptr<CLI::App> make_app(Choice& choice) {
  choice.options.decimation = 20;
  auto app =
      std::make_unique<CLI::App>("Publishes what the haptics daemon does to a NATS server", "haptic-bridge");
  app->set_version_flag("--version", "haptic-bridge " HAPTIC_VERSION);
  app->set_config("--config", "", "a file with these options, one \"name = value\" a line")
      ->type_name("FILE");
  app->allow_config_extras(CLI::config_extras_mode::error);
  add_stream_options(*app, choice);
  add_daemon_options(*app, choice.options.daemon);
  add_broker_options(*app, choice.options.broker);
  app->footer("Ends on SIGTERM or SIGINT. Exit codes: 0 done, 1 failed, 64 usage.");
  return app;
}

Options options_of(Choice choice) {
  Options options = std::move(choice.options);
  if (options.host.empty()) {
    options.host = own_host();
  }
  if (options.broker.urls.empty()) {
    options.broker.urls.emplace_back(kUsualUrl);
  }
  if (options.topics.empty()) {
    options.topics = {v1::OBJECTS, v1::HIPS, v1::DEVICES, v1::EVENTS, v1::STATS};
  }
  std::sort(options.topics.begin(), options.topics.end());
  options.topics.erase(std::unique(options.topics.begin(), options.topics.end()), options.topics.end());
  options.keep = choice.lossless ? Keep::kAll : Keep::kLatest;
  options.daemon.program = "haptic-bridge";
  options.daemon.timeout = kDaemonTimeout;
  options.broker.name = "haptic-bridge " + options.host;
  return options;
}

}  // namespace haptic::bridge
