#include "client/view/token.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/temporary_folder.h"

namespace haptic::gateway {
namespace {

constexpr const char* kSecret = "0123456789abcdef-._~";

TEST(Token, IsItselfAndNothingElse) {
  const Token token(kSecret);
  EXPECT_TRUE(token.is(kSecret));
  EXPECT_FALSE(token.is(""));
  EXPECT_FALSE(token.is("0123456789abcdef-._"));
  EXPECT_FALSE(token.is("0123456789abcdef-._~~"));
  EXPECT_FALSE(token.is("1123456789abcdef-._~"));
}

TEST(Token, HasSixteenPlainCharactersAtLeast) {
  EXPECT_EQ(Token::problem(std::string(16, 'a')), "");
  EXPECT_NE(Token::problem(std::string(15, 'a')), "");
  EXPECT_EQ(Token::problem(std::string(256, 'a')), "");
  EXPECT_NE(Token::problem(std::string(257, 'a')), "");
  for (const char c : {' ', '\n', '%', '&', '+', '/', '\0', '\xe4'}) {
    EXPECT_NE(Token::problem(std::string(16, 'a') + c), "") << static_cast<int>(c);
  }
}

TEST(Token, IsTheOnlyLineOfItsFile) {
  const test::TemporaryFolder folder;
  for (const char* const end : {"", "\n", "\r\n"}) {
    EXPECT_TRUE(Token::from_file(folder.write("token", std::string(kSecret) + end)).is(kSecret));
  }
  EXPECT_THROW(Token::from_file(folder.write("two", std::string(kSecret) + "\n" + kSecret + "\n")),
               std::runtime_error);
  EXPECT_THROW(Token::from_file(folder.write("empty", "")), std::runtime_error);
  EXPECT_THROW(Token::from_file(folder.write("huge", std::string(100'000, 'a'))), std::runtime_error);
  EXPECT_THROW(Token::from_file(folder.file("none")), std::runtime_error);
}

TEST(Token, IsNotToldByAnError) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("token", "my secret token which has blanks");
  try {
    Token::from_file(file);
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(file), std::string::npos);
    EXPECT_EQ(text.find("secret"), std::string::npos);
  }
}

}  // namespace
}  // namespace haptic::gateway
