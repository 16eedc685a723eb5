#include "client/view/origin.h"

#include <gtest/gtest.h>

namespace haptic::gateway {
namespace {

TEST(HostName, IsWithoutPortAndBrackets) {
  EXPECT_EQ(host_name("localhost"), "localhost");
  EXPECT_EQ(host_name("LocalHost:8765"), "localhost");
  EXPECT_EQ(host_name("127.0.0.1:8765"), "127.0.0.1");
  EXPECT_EQ(host_name("[::1]:8765"), "::1");
  EXPECT_EQ(host_name("[::1]"), "::1");
  EXPECT_EQ(host_name("my-lab.example"), "my-lab.example");
}

TEST(HostName, IsNothingForAnythingElse) {
  for (const char* const host : {"", ":80", "a:", "a:b", "a:80:90", "a:123456", "::1", "[::1", "[]", "[a]:80",
                                 "[127.0.0.1]", "a b", "a/b", "user@host", "a,b", "[::1]x", "h\xc3\xb6st"}) {
    EXPECT_EQ(host_name(host), std::nullopt) << host;
  }
}

TEST(OwnHost, IsAnAddressOrLocalhost) {
  for (const char* const host : {"127.0.0.1:8765", "localhost:1", "[::1]:8765", "192.0.2.7"}) {
    EXPECT_TRUE(is_own_host(host, {})) << host;
  }
}

// a name of somebody else's that leads to this machine, by which his page would be of our origin
TEST(OwnHost, IsNoNameButThoseThatAreAllowed) {
  EXPECT_FALSE(is_own_host("rebound.example:8765", {}));
  EXPECT_FALSE(is_own_host("localhost.example", {}));
  EXPECT_FALSE(is_own_host("127.0.0.1.example", {}));
  EXPECT_TRUE(is_own_host("Lab.example:8765", {"lab.example"}));
  EXPECT_FALSE(is_own_host("x.lab.example", {"lab.example"}));
}

TEST(OwnOrigin, IsThatOfTheHostWithItsSchemeAndPort) {
  const OriginRule plain;
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8765", "127.0.0.1:8765", plain));
  EXPECT_TRUE(is_own_origin("HTTP://LOCALHOST:8765", "localhost:8765", plain));
  EXPECT_FALSE(is_own_origin("https://127.0.0.1:8765", "127.0.0.1:8765", plain));
  EXPECT_FALSE(is_own_origin("http://127.0.0.1:8766", "127.0.0.1:8765", plain));
  EXPECT_FALSE(is_own_origin("http://127.0.0.1", "127.0.0.1:8765", plain));
  EXPECT_FALSE(is_own_origin("http://localhost:8765", "127.0.0.1:8765", plain));
  EXPECT_FALSE(is_own_origin("null", "127.0.0.1:8765", plain));
  EXPECT_FALSE(is_own_origin("", "127.0.0.1:8765", plain));
  const OriginRule tls{.tls = true, .allowed = {}};
  EXPECT_TRUE(is_own_origin("https://lab.example", "lab.example", tls));
  EXPECT_FALSE(is_own_origin("http://lab.example", "lab.example", tls));
}

TEST(OwnOrigin, CanBeOneThatIsAllowed) {
  const OriginRule rule{.tls = false, .allowed = {"https://app.foxglove.dev"}};
  EXPECT_TRUE(is_own_origin("https://app.foxglove.dev", "127.0.0.1:8765", rule));
  EXPECT_FALSE(is_own_origin("http://app.foxglove.dev", "127.0.0.1:8765", rule));
  EXPECT_FALSE(is_own_origin("https://app.foxglove.dev.example", "127.0.0.1:8765", rule));
}

TEST(OriginProblem, IsToldOfWhatIsNoOrigin) {
  EXPECT_EQ(origin_problem("https://app.foxglove.dev"), "");
  EXPECT_EQ(origin_problem("http://localhost:5173"), "");
  for (const char* const text :
       {"", "*", "app.foxglove.dev", "://a", "https://", "https://a/b", "https://a:b"}) {
    EXPECT_NE(origin_problem(text), "") << text;
  }
}

}  // namespace
}  // namespace haptic::gateway
