#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "ipc/tls.h"

namespace haptic::ipc {
namespace {

struct Free {
  void operator()(FILE* file) const noexcept { std::fclose(file); }
  void operator()(X509* certificate) const noexcept { X509_free(certificate); }
  void operator()(EVP_PKEY* key) const noexcept { EVP_PKEY_free(key); }
};
template <class Thing>
using Owned = std::unique_ptr<Thing, Free>;

// nobody can be asked for a password
int no_password(char* /*buffer*/, int /*size*/, int /*for_writing*/, void* /*data*/) { return -1; }

class FileCheck {
 public:
  Owned<X509> certificate(const std::string& field, const std::string& path) {
    const Owned<FILE> file = open(field, path);
    if (!file) {
      return nullptr;
    }
    Owned<X509> certificate(PEM_read_X509(file.get(), nullptr, no_password, nullptr));
    if (!certificate) {
      complain(field, path, "is no certificate in PEM");
    } else if (X509_cmp_current_time(X509_get0_notBefore(certificate.get())) > 0) {
      complain(field, path, "is not valid yet; is the clock of this machine right?");
    } else if (X509_cmp_current_time(X509_get0_notAfter(certificate.get())) < 0) {
      complain(field, path, "is no longer valid; make a new one");
    }
    ERR_clear_error();
    return certificate;
  }

  void key(const std::string& path, const X509* certificate) {
    const Owned<FILE> file = open("key", path);
    if (!file) {
      return;
    }
    const Owned<EVP_PKEY> key(PEM_read_PrivateKey(file.get(), nullptr, no_password, nullptr));
    if (!key) {
      complain("key", path, "is no private key in PEM, or it needs a password");
    } else if (certificate != nullptr && X509_check_private_key(certificate, key.get()) != 1) {
      complain("key", path, "is not the key of the certificate");
    }
    ERR_clear_error();
  }

  std::vector<TlsFileProblem> problems;

 private:
  Owned<FILE> open(const std::string& field, const std::string& path) {
    Owned<FILE> file(std::fopen(path.c_str(), "re"));
    if (!file) {
      problems.push_back({field, "cannot open " + path + ": " + std::strerror(errno)});
    }
    return file;
  }
  void complain(const std::string& field, const std::string& path, const std::string& what) {
    problems.push_back({field, path + " " + what});
  }
};

}  // namespace

std::vector<TlsFileProblem> find_problems(const v1::Listen::Tls& config) {
  FileCheck check;
  const Owned<X509> certificate = check.certificate("certificate", config.certificate());
  check.key(config.key(), certificate.get());
  check.certificate("authority", config.authority());
  return std::move(check.problems);
}

}  // namespace haptic::ipc
