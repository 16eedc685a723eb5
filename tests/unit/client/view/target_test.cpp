#include "client/view/target.h"

#include <gtest/gtest.h>

namespace haptic::gateway {
namespace {

std::string path_of(std::string_view text) {
  const auto target = parse_target(text);
  return target ? target->path : "(none)";
}

TEST(Target, IsAPathBelowThePage) {
  EXPECT_EQ(path_of("/ws"), "/ws");
  EXPECT_EQ(path_of("/assets/index-1a2b.js"), "/assets/index-1a2b.js");
  EXPECT_EQ(path_of("/a%20b.txt"), "/a b.txt");
  EXPECT_EQ(path_of("/file.js?v=1"), "/file.js");
}

TEST(Target, WithASlashAtItsEndIsTheIndex) {
  EXPECT_EQ(path_of("/"), "/index.html");
  EXPECT_EQ(path_of("/?token=a"), "/index.html");
  EXPECT_EQ(path_of("/help/"), "/help/index.html");
}

TEST(Target, NeverLeadsOutOfThePage) {
  for (const char* const text : {"",
                                 "index.html",
                                 "..",
                                 "/..",
                                 "/../etc/passwd",
                                 "/a/../b",
                                 "/a/..",
                                 "/.",
                                 "/./a",
                                 "/.git/config",
                                 "/%2e%2e/etc/passwd",
                                 "/%2E./x",
                                 "/..%2fetc/passwd",
                                 "/a%2fb",
                                 "/a%5cb",
                                 "/a\\..\\b",
                                 "//etc/passwd",
                                 "/a//b",
                                 "/a%00.html",
                                 "/a%0a",
                                 "/%7f",
                                 "http://elsewhere/",
                                 "*"}) {
    EXPECT_EQ(path_of(text), "(none)") << text;
  }
}

TEST(Target, IsEncodedRightly) {
  for (const char* const text : {"/%", "/%4", "/%4g", "/%g4", "/a%"}) {
    EXPECT_EQ(path_of(text), "(none)") << text;
  }
  // what is decoded is not decoded again
  EXPECT_EQ(path_of("/%252e%252e"), "/%2e%2e");
}

TEST(Target, HasTheTokenOfItsQuery) {
  EXPECT_EQ(parse_target("/ws")->token, std::nullopt);
  EXPECT_EQ(parse_target("/ws?")->token, std::nullopt);
  EXPECT_EQ(parse_target("/ws?token=abc")->token, "abc");
  EXPECT_EQ(parse_target("/ws?a=1&token=a%2Dc&b")->token, "a-c");
  EXPECT_EQ(parse_target("/ws?token=")->token, "");
  EXPECT_EQ(parse_target("/ws?mytoken=abc")->token, std::nullopt);
}

TEST(Target, WithTwoTokensOrAWrongOneIsNone) {
  EXPECT_FALSE(parse_target("/ws?token=a&token=b"));
  EXPECT_FALSE(parse_target("/ws?token=%zz"));
}

}  // namespace
}  // namespace haptic::gateway
