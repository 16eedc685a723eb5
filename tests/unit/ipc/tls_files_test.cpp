// What `hapticd check` says of the files that listen.tcp.tls names.

#include <gtest/gtest.h>

#include "client/lib/certificates.h"
#include "ipc/tls.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace haptic::ipc {
namespace {

class TlsFiles : public testing::Test {
 protected:
  TlsFiles() {
    client::make_certificates({folder_.file("lab"), {"localhost"}, {"alice"}});
    config_.set_certificate(folder_.file("lab/server.crt"));
    config_.set_key(folder_.file("lab/server.key"));
    config_.set_authority(folder_.file("lab/authority.crt"));
  }

  // "field: message", with the folder left away
  std::vector<std::string> problems() const {
    std::vector<std::string> texts;
    for (const TlsFileProblem& problem : find_problems(config_)) {
      std::string text = problem.field + ": " + problem.message;
      const std::string folder = folder_.file("");
      if (const std::size_t at = text.find(folder); at != std::string::npos) {
        text.erase(at, folder.size());
      }
      texts.push_back(text);
    }
    return texts;
  }

  test::TemporaryFolder folder_;
  v1::Listen::Tls config_;
};

using Texts = std::vector<std::string>;

TEST_F(TlsFiles, OfCertificatesHaveNoProblems) { EXPECT_EQ(problems(), Texts()); }

TEST_F(TlsFiles, AreEachToldIfTheyCannotBeOpened) {
  config_.set_certificate(folder_.file("a.crt"));
  config_.set_key(folder_.file("b.key"));
  config_.set_authority(folder_.file("c.crt"));
  EXPECT_EQ(problems(), (Texts{"certificate: cannot open a.crt: No such file or directory",
                               "key: cannot open b.key: No such file or directory",
                               "authority: cannot open c.crt: No such file or directory"}));
}

TEST_F(TlsFiles, AreEachToldIfTheyAreSomethingElse) {
  const std::string text = folder_.write("text", "no certificate\n");
  config_.set_certificate(config_.key());
  config_.set_key(text);
  config_.set_authority(text);
  EXPECT_EQ(problems(), (Texts{"certificate: lab/server.key is no certificate in PEM",
                               "key: text is no private key in PEM, or it needs a password",
                               "authority: text is no certificate in PEM"}));
}

TEST_F(TlsFiles, MustBelongTogether) {
  config_.set_key(folder_.file("lab/alice.key"));
  EXPECT_EQ(problems(), Texts{"key: lab/alice.key is not the key of the certificate"});
}

TEST_F(TlsFiles, MustBeValidToday) {
  // made for 1 January 2020 alone
  config_.set_authority(test::source_dir() + "/tests/data/expired.crt");
  const Texts found = problems();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].find("expired.crt is no longer valid"), std::string::npos) << found[0];
}

}  // namespace
}  // namespace haptic::ipc
