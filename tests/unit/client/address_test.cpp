#include "client/lib/address.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace haptic::client {
namespace {

TEST(Address, WithASlashOrWithoutAColonIsAPath) {
  EXPECT_EQ(parse_address("/run/a:b.sock").path, "/run/a:b.sock");
  EXPECT_EQ(parse_address("local.sock").path, "local.sock");
}

TEST(Address, WithAColonIsHostAndPort) {
  const Address address = parse_address("127.0.0.1:7411");
  EXPECT_EQ(address.path, "");
  EXPECT_EQ(address.host, "127.0.0.1");
  EXPECT_EQ(address.port, "7411");
}

TEST(Address, OfIpv6IsInBrackets) {
  const Address address = parse_address("[::1]:7411");
  EXPECT_EQ(address.host, "::1");
  EXPECT_EQ(address.port, "7411");
  EXPECT_EQ(to_string(address), "[::1]:7411");
}

TEST(Address, ThatIsEmptyIsTheDefaultPlace) {
  ::setenv("HAPTICD_SOCKET", "/tmp/example.sock", 1);
  EXPECT_EQ(parse_address("").path, "/tmp/example.sock");
  ::unsetenv("HAPTICD_SOCKET");
}

}  // namespace
}  // namespace haptic::client
