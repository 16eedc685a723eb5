#pragma once
// A small authority for a laboratory: its own certificate, one for the daemon, and one for each client.
// Elliptic curve P-256. What a large site has instead is an authority of its own.

#include <filesystem>
#include <string>
#include <vector>

namespace haptic::client {

struct CertificatePlan {
  std::filesystem::path folder;           // is made if need be, for its owner only
  std::vector<std::string> server_names;  // host names and IP addresses that clients call the daemon by
  std::vector<std::string> clients;       // what the config allows; each is also the name of a file
};

/// The files, in their order: authority, server, each client; .crt and .key of each. Keys have mode 0600.
/// Throws Invalid for a name that cannot be used, Error if a file is there already or cannot be written; then
/// none of them has been written, unless the disk failed.
std::vector<std::filesystem::path> make_certificates(const CertificatePlan& plan);

}  // namespace haptic::client
