#include "client/view/command_line.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace haptic::gateway {
namespace {

constexpr const char* kSecret = "0123456789abcdef0123456789abcdef";

class ViewCommandLine : public testing::Test {
 protected:
  ViewCommandLine() {
    token_ = folder_.write("token", kSecret);
    certificate_ = folder_.write("a.crt", "");
    key_ = folder_.write("a.key", "");
  }

  Options parse(const std::string& line) const {
    Choice choice;
    make_app(choice)->parse(line);
    return options_of(std::move(choice));
  }

  std::string tls() const { return " --certificate " + certificate_ + " --key " + key_; }

  test::TemporaryFolder folder_;
  std::string token_;
  std::string certificate_;
  std::string key_;
};

TEST_F(ViewCommandLine, ServesThisMachineAloneAndLetsItObserve) {
  const Options options = parse("");
  EXPECT_EQ(options.web.address, "127.0.0.1");
  EXPECT_EQ(options.web.port, 8765);
  EXPECT_FALSE(options.web.rules.anybody_drives);
  EXPECT_FALSE(options.web.rules.tokens.observe);
  EXPECT_FALSE(options.web.rules.tokens.drive);
  EXPECT_EQ(options.frames_per_second, 60.0);
  EXPECT_EQ(options.web.page.filename(), "view");
}

TEST_F(ViewCommandLine, ListensWhereItIsTold) {
  EXPECT_EQ(parse("--listen 127.0.0.2:0").web.address, "127.0.0.2");
  EXPECT_EQ(parse("--listen localhost:80").web.address, "127.0.0.1");
  EXPECT_EQ(parse("--listen [::1]:80").web.address, "::1");
  EXPECT_EQ(parse("--listen [::1]:80").web.port, 80);
  for (const char* const place : {"8765", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "::1:80", "[::1]",
                                  "[127.0.0.1]:80", "host:80", "127.0.0.1:-1", "127.0.0.1:8a"}) {
    EXPECT_THROW(parse("--listen " + std::string(place)), CLI::ParseError) << place;
  }
}

TEST_F(ViewCommandLine, GoesBeyondThisMachineOnlyWithTlsAndAToken) {
  for (const char* const place : {"0.0.0.0:8765", "192.0.2.7:8765", "[::]:8765", "[::ffff:192.0.2.7]:80"}) {
    const std::string listen = "--listen " + std::string(place);
    EXPECT_THROW(parse(listen), CLI::ParseError) << place;
    EXPECT_THROW(parse(listen + tls()), CLI::ParseError) << place;
    EXPECT_THROW(parse(listen + " --token-file " + token_), CLI::ParseError) << place;
    EXPECT_THROW(parse(listen + tls() + " --drive-token-file " + token_), CLI::ParseError) << place;
    EXPECT_THROW(parse(listen + tls() + " --drive"), CLI::ParseError) << place;
    EXPECT_TRUE(parse(listen + tls() + " --token-file " + token_).web.rules.origin.tls) << place;
  }
  EXPECT_EQ(parse("--listen [::ffff:127.0.0.1]:80").web.port, 80);
}

TEST_F(ViewCommandLine, ReadsTokensFromFiles) {
  const Options options = parse("--token-file " + token_ + " --drive-token-file " + token_);
  ASSERT_TRUE(options.web.rules.tokens.observe && options.web.rules.tokens.drive);
  EXPECT_TRUE(options.web.rules.tokens.observe->is(kSecret));
  EXPECT_TRUE(options.web.rules.tokens.drive->is(kSecret));
  EXPECT_THROW(parse("--token-file " + folder_.write("short", "abc")), std::runtime_error);
}

TEST_F(ViewCommandLine, LetsEverybodyDriveOnlyWhereThereAreNoTokens) {
  EXPECT_TRUE(parse("--drive").web.rules.anybody_drives);
  EXPECT_THROW(parse("--drive --token-file " + token_), CLI::ParseError);
  EXPECT_THROW(parse("--drive --drive-token-file " + token_), CLI::ParseError);
}

TEST_F(ViewCommandLine, KnowsWhatIsAnOriginAndWhatAHost) {
  const Options options = parse("--allow-origin https://app.foxglove.dev --allow-host Lab.Example");
  EXPECT_EQ(options.web.rules.origin.allowed, std::vector<std::string>{"https://app.foxglove.dev"});
  EXPECT_EQ(options.web.rules.hosts, std::vector<std::string>{"lab.example"});
  EXPECT_THROW(parse("--allow-origin *"), CLI::ParseError);
  EXPECT_THROW(parse("--allow-host lab.example:80"), CLI::ParseError);
}

TEST_F(ViewCommandLine, TakesACertificateWithItsKey) {
  EXPECT_THROW(parse("--certificate " + certificate_), CLI::ParseError);
  EXPECT_THROW(parse("--key " + key_), CLI::ParseError);
  EXPECT_THROW(parse("--daemon-certificate " + certificate_ + " --daemon-key " + key_), CLI::ParseError);
  EXPECT_EQ(parse("--daemon-certificate " + certificate_ + " --daemon-key " + key_ + " --daemon-authority " +
                  certificate_)
                .identity.key,
            key_);
}

TEST_F(ViewCommandLine, HasLimits) {
  EXPECT_EQ(parse("--rate 30").frames_per_second, 30.0);
  EXPECT_EQ(parse("--clients 3").web.sockets, 3U);
  for (const char* const wrong : {"--rate 0", "--rate 1001", "--rate nan", "--clients 0", "--clients 1001",
                                  "--page /none", "--unknown", "positional"}) {
    EXPECT_THROW(parse(wrong), CLI::ParseError) << wrong;
  }
}

}  // namespace
}  // namespace haptic::gateway
