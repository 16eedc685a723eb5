#include "client/view/command_line.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cmath>
#include <filesystem>
#include <optional>

namespace haptic::gateway {
namespace {

namespace ip = boost::asio::ip;

CLI::Validator existing_file() { return CLI::Validator(CLI::ExistingFile).description(""); }

struct Place {
  ip::address address;
  unsigned short port = 0;
};

// ADDRESS:PORT; an IPv6 address in brackets
std::optional<Place> parse_place(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (port.empty() || port.size() > 5 ||
      !std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; }) ||
      std::stoul(port) > 65535) {
    return std::nullopt;
  }
  std::string host = text.substr(0, colon);
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  host = bracketed ? host.substr(1, host.size() - 2) : host;
  boost::system::error_code error;
  const ip::address address = ip::make_address(host == "localhost" ? "127.0.0.1" : host, error);
  if (error || address.is_v6() != bracketed) {
    return std::nullopt;
  }
  return Place{address, static_cast<unsigned short>(std::stoul(port))};
}

bool is_of_this_machine(const ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return ip::make_address_v4(ip::v4_mapped, address.to_v6()).is_loopback();
  }
  return address.is_loopback();
}

void add_daemon_options(CLI::App& app, Options& options) {
  app.add_option("--server,--socket", options.daemon, "the daemon's socket: a path, or host:port")
      ->type_name("ADDRESS");
  app.add_option("--daemon-certificate", options.identity.certificate,
                 "for TLS with the daemon: your certificate")
      ->envname("HAPTICD_CERTIFICATE")
      ->check(existing_file())
      ->type_name("FILE");
  app.add_option("--daemon-key", options.identity.key, "for TLS with the daemon: its key")
      ->envname("HAPTICD_KEY")
      ->check(existing_file())
      ->type_name("FILE");
  app.add_option("--daemon-authority", options.identity.authority,
                 "for TLS with the daemon: who must have signed its certificate")
      ->envname("HAPTICD_AUTHORITY")
      ->check(existing_file())
      ->type_name("FILE");
}

void add_web_options(CLI::App& app, Choice& choice) {
  WebSettings& web = choice.options.web;
  app.add_option("--listen", choice.listen,
                 "where browsers come, ADDRESS:PORT; port 0: any that is free; beyond this machine only with "
                 "--certificate and --token-file; default: 127.0.0.1:8765")
      ->check(CLI::Validator(
          [](const std::string& text) {
            return parse_place(text)
                       ? std::string()
                       : "\"" + text + "\" is no ADDRESS:PORT; an IPv6 address stands in brackets";
          },
          ""))
      ->type_name("ADDRESS:PORT");
  app.add_option("--page", choice.page, "the folder of the page; default: the one that is installed")
      ->check(CLI::Validator(CLI::ExistingDirectory).description(""))
      ->type_name("FOLDER");
  CLI::Option* const certificate =
      app.add_option("--certificate", web.certificate, "for TLS with browsers: the certificate, PEM")
          ->check(existing_file())
          ->type_name("FILE");
  CLI::Option* const key = app.add_option("--key", web.key, "for TLS with browsers: its key")
                               ->check(existing_file())
                               ->type_name("FILE");
  certificate->needs(key);
  key->needs(certificate);
}

void add_access_options(CLI::App& app, Choice& choice) {
  WebSettings& web = choice.options.web;
  CLI::Option* const token =
      app.add_option("--token-file", choice.token_file,
                     "only who shows the token in this file may observe: http://ADDRESS:PORT/?token=TOKEN")
          ->check(existing_file())
          ->type_name("FILE");
  CLI::Option* const drive_token =
      app.add_option("--drive-token-file", choice.drive_token_file,
                     "who shows the token in this file may drive: arm, disarm, stop, move devices")
          ->check(existing_file())
          ->type_name("FILE");
  app.add_flag("--drive", web.rules.anybody_drives,
               "everybody who can use this machine may drive, without a token")
      ->excludes(token)
      ->excludes(drive_token);
  app.add_option("--allow-origin", web.rules.origin.allowed,
                 "let pages from there in, too, for instance https://app.foxglove.dev; repeatable")
      ->check(CLI::Validator([](const std::string& text) { return origin_problem(text); }, ""))
      ->type_name("ORIGIN");
  app.add_option("--allow-host", web.rules.hosts,
                 "a name by which browsers call this server, beside localhost and IP addresses; repeatable")
      ->transform(CLI::Validator(
          [](std::string& text) {
            const std::optional<std::string> name = host_name(text);
            if (!name || text.find_first_of(":[]") != std::string::npos) {
              return "\"" + text + "\" is no host's name";
            }
            text = *name;
            return std::string();
          },
          ""))
      ->type_name("NAME");
}

void add_limits(CLI::App& app, Choice& choice) {
  app.add_option("--rate", choice.options.frames_per_second,
                 "the most frames a second that a page gets; default: 60")
      ->check(CLI::Validator(
          [](const std::string& text) {
            double rate = NAN;
            const bool is_one = CLI::detail::lexical_cast(text, rate) && rate >= 1.0 && rate <= 1000.0;
            return is_one ? std::string() : text + " is no rate between 1 and 1000";
          },
          ""))
      ->type_name("HZ");
  app.add_option("--clients", choice.options.web.sockets, "the most pages and viewers at once; default: 16")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N");
}

std::filesystem::path installed_page() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return (program.parent_path() / HAPTIC_PAGE_FROM_PROGRAM).lexically_normal();
}

}  // namespace

std::unique_ptr<CLI::App> make_app(Choice& choice) {
  auto app = std::make_unique<CLI::App>(
      "Shows the haptics daemon to browsers, and to viewers that speak Foxglove's protocol", "haptic-view");
  app->set_version_flag("--version", "haptic-view " HAPTIC_VERSION);
  app->set_config("--config", "", "a file with these options, one \"name = value\" a line")
      ->type_name("FILE");
  app->allow_config_extras(CLI::config_extras_mode::error);
  add_daemon_options(*app, choice.options);
  add_web_options(*app, choice);
  add_access_options(*app, choice);
  add_limits(*app, choice);
  app->footer("Ends on SIGTERM or SIGINT. Exit codes: 0 done, 1 failed, 64 usage.");
  return app;
}

Options options_of(Choice choice) {
  Options options = std::move(choice.options);
  WebSettings& web = options.web;
  const Place place = parse_place(choice.listen).value_or(Place());
  web.address = place.address.to_string();
  web.port = place.port;
  web.rules.origin.tls = !web.certificate.empty();
  if (!is_of_this_machine(place.address)) {
    if (web.certificate.empty() || choice.token_file.empty()) {
      throw CLI::ValidationError("--listen", choice.listen +
                                                 " is beyond this machine: it takes --certificate, --key "
                                                 "and --token-file");
    }
  }
  const client::Identity& identity = options.identity;
  if (!identity.empty() &&
      (identity.certificate.empty() || identity.key.empty() || identity.authority.empty())) {
    throw CLI::ValidationError("--daemon-certificate",
                               "TLS with the daemon takes all of --daemon-certificate, --daemon-key and "
                               "--daemon-authority");
  }
  if (!choice.token_file.empty()) {
    web.rules.tokens.observe = Token::from_file(choice.token_file);
  }
  if (!choice.drive_token_file.empty()) {
    web.rules.tokens.drive = Token::from_file(choice.drive_token_file);
  }
  web.page = choice.page.empty() ? installed_page() : std::filesystem::path(choice.page);
  return options;
}

}  // namespace haptic::gateway
