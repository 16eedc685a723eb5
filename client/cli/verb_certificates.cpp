#include <fmt/format.h>

#include "client/cli/verbs.h"
#include "client/lib/certificates.h"

namespace haptic::cli {
namespace {

std::string text_of(const std::filesystem::path& path) {
  return std::filesystem::absolute(path).lexically_normal();
}

void print_config(const client::CertificatePlan& plan) {
  const std::string server = text_of(plan.folder / "server");
  fmt::print(
      "\nIn the daemon's config, with the role that each of them shall have:\n\n"
      "listen {{\n"
      "  tcp {{\n"
      "    address: \"0.0.0.0\"\n"
      "    port: 7411\n"
      "    tls {{\n"
      "      certificate: \"{}.crt\"\n"
      "      key: \"{}.key\"\n"
      "      authority: \"{}\"\n"
      "    }}\n",
      server, server, text_of(plan.folder / "authority.crt"));
  for (const std::string& name : plan.clients) {
    fmt::print("    allow {{ name: \"{}\" role: OBSERVE }}\n", name);
  }
  fmt::print("  }}\n}}\n");
}

ExitCode make(const Command& command, const client::CertificatePlan& plan) {
  const std::vector<std::filesystem::path> files = client::make_certificates(plan);
  if (command.json) {
    std::string list;
    for (const std::filesystem::path& file : files) {
      std::string text;
      for (const char c : text_of(file)) {
        text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
      }
      list += (list.empty() ? "\"" : ",\"") + text + "\"";
    }
    fmt::print("{{\"file\":[{}]}}\n", list);
    return kDone;
  }
  for (const std::filesystem::path& file : files) {
    fmt::print("{}\n", text_of(file));
  }
  print_config(plan);
  const std::string client = plan.clients.empty() ? "NAME" : plan.clients.front();
  fmt::print(
      "\nGive each client its own two files and authority.crt:\n\n"
      "hapticctl --server {}:7411 --certificate {}.crt --key {}.key --authority authority.crt status\n\n"
      "Keep authority.key apart from all of them: who has it can make more clients.\n",
      plan.server_names.front(), client, client);
  return kDone;
}

}  // namespace

void add_certificates(CLI::App& app, Command& command) {
  struct Choice {
    std::string folder;
    client::CertificatePlan plan;
  };
  const auto choice = std::make_shared<Choice>();
  CLI::App& verb = add_verb(app, command, "certificates",
                            "make an authority and certificates, for clients on other machines",
                            [choice](Command& chosen) {
                              choice->plan.folder = choice->folder;
                              return make(chosen, choice->plan);
                            });
  add_option(verb, "folder", choice->folder, "where the files go; nothing is overwritten").required();
  add_option(verb, "--server-name", choice->plan.server_names,
             "the daemon's host, by name or IP address; repeatable")
      .required()
      .type("NAME");
  add_option(verb, "--client", choice->plan.clients, "a client's name, as the config allows it; repeatable")
      .type("NAME");
}

}  // namespace haptic::cli
