#include "client/lib/certificates.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <functional>
#include <memory>
#include <string_view>

#include "client/lib/address.h"
#include "client/lib/error.h"

namespace haptic::client {
namespace {

using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;

constexpr long kDay = 24L * 3600;
constexpr long kAuthorityDays = 3650;
constexpr long kMemberDays = 3650;
constexpr std::size_t kLongestName = 64;  // of a common name

[[noreturn]] void fail(v1::Error::Code code, const std::string& message) {
  v1::Error error;
  error.set_code(code);
  error.set_message(message);
  throw_error(error);
}

void require(bool worked, const char* what) {
  if (!worked) {
    fail(v1::Error::FAILED, std::string("OpenSSL cannot ") + what);
  }
}

// letters, digits and few signs: such a name is one of a file, and means nothing more in an extension
void check_name(const std::string& name, std::string_view signs) {
  const bool is_plain = std::all_of(name.begin(), name.end(), [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           signs.find(c) != std::string_view::npos;
  });
  if (name.empty() || name.size() > kLongestName || name.front() == '.' || name.front() == '-' || !is_plain) {
    fail(v1::Error::INVALID, "\"" + name + "\" cannot be a name: 1 to " + std::to_string(kLongestName) +
                                 " letters, digits and " + std::string(signs) + ", the first no sign");
  }
}

void check_plan(const CertificatePlan& plan) {
  if (plan.server_names.empty()) {
    fail(v1::Error::INVALID, "the daemon's certificate needs a name: that of its host");
  }
  for (const std::string& name : plan.server_names) {
    if (!is_ip(name)) {
      check_name(name, ".-");
    }
  }
  std::vector<std::string> taken = {"authority", "server"};
  for (const std::string& name : plan.clients) {
    check_name(name, "._-");
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      fail(v1::Error::INVALID, "\"" + name + "\" is taken already");
    }
    taken.push_back(name);
  }
}

Key make_key() {
  Key key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
  require(key != nullptr, "make a key");
  return key;
}

void add_extension(X509* certificate, X509* issuer, int kind, const std::string& value) {
  X509V3_CTX context{};
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()), &X509_EXTENSION_free);
  require(extension && X509_add_ext(certificate, extension.get(), -1) == 1, "add an extension");
}

// not yet signed; `issuer` null: its own
Certificate make_certificate(const std::string& name, EVP_PKEY* key, X509* issuer, long days) {
  Certificate made(X509_new(), &X509_free);
  std::array<unsigned char, 16> serial{};
  require(made && RAND_bytes(serial.data(), serial.size()) == 1, "make a certificate");
  serial[0] &= 0x7f;
  const std::unique_ptr<BIGNUM, decltype(&BN_free)> number(BN_bin2bn(serial.data(), serial.size(), nullptr),
                                                           &BN_free);
  BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(made.get()));
  X509_set_version(made.get(), X509_VERSION_3);
  X509_gmtime_adj(X509_getm_notBefore(made.get()), -kDay);  // clocks differ
  X509_gmtime_adj(X509_getm_notAfter(made.get()), days * kDay);
  X509_set_pubkey(made.get(), key);
  X509_NAME_add_entry_by_NID(X509_get_subject_name(made.get()), NID_commonName, MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(name.data()),
                             static_cast<int>(name.size()), -1, 0);
  X509_set_issuer_name(made.get(), X509_get_subject_name(issuer == nullptr ? made.get() : issuer));
  add_extension(made.get(), issuer == nullptr ? made.get() : issuer, NID_subject_key_identifier, "hash");
  return made;
}

void sign(X509* certificate, EVP_PKEY* key) {
  require(X509_sign(certificate, key, EVP_sha256()) > 0, "sign a certificate");
}

struct Authority {
  Key key = make_key();
  Certificate certificate = make_certificate("hapticd authority", key.get(), nullptr, kAuthorityDays);

  Authority() {
    add_extension(certificate.get(), certificate.get(), NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
    add_extension(certificate.get(), certificate.get(), NID_key_usage, "critical,keyCertSign,cRLSign");
    sign(certificate.get(), key.get());
  }
};

// a file that must not be there yet
class NewFile {
 public:
  NewFile(const std::filesystem::path& path, mode_t mode)
      : path_(path),
        descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode)) {
    if (descriptor_ < 0) {
      fail(v1::Error::FAILED, "cannot make " + path.string() + ": " + std::strerror(errno));
    }
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile() { ::close(descriptor_); }

  void write(const std::function<int(BIO*)>& write) {
    const std::unique_ptr<BIO, decltype(&BIO_free)> bio(BIO_new_fd(descriptor_, BIO_NOCLOSE), &BIO_free);
    if (!bio || write(bio.get()) != 1) {
      fail(v1::Error::FAILED, "cannot write " + path_.string());
    }
  }

 private:
  std::filesystem::path path_;
  int descriptor_;
};

void save(const std::filesystem::path& stem, EVP_PKEY* key, X509* certificate) {
  NewFile(stem.string() + ".key", 0600).write([&](BIO* bio) {
    return PEM_write_bio_PrivateKey(bio, key, nullptr, nullptr, 0, nullptr, nullptr);
  });
  NewFile(stem.string() + ".crt", 0644).write([&](BIO* bio) { return PEM_write_bio_X509(bio, certificate); });
}

void save_member(const std::filesystem::path& stem, const Authority& authority, const std::string& name,
                 const char* usage, const std::string& other_names) {
  const Key key = make_key();
  X509* const issuer = authority.certificate.get();
  const Certificate made = make_certificate(name, key.get(), issuer, kMemberDays);
  add_extension(made.get(), issuer, NID_authority_key_identifier, "keyid:always");
  add_extension(made.get(), issuer, NID_basic_constraints, "critical,CA:FALSE");
  add_extension(made.get(), issuer, NID_key_usage, "critical,digitalSignature");
  add_extension(made.get(), issuer, NID_ext_key_usage, usage);
  if (!other_names.empty()) {
    add_extension(made.get(), issuer, NID_subject_alt_name, other_names);
  }
  sign(made.get(), authority.key.get());
  save(stem, key.get(), made.get());
}

}  // namespace

std::vector<std::filesystem::path> make_certificates(const CertificatePlan& plan) {
  check_plan(plan);
  if (::mkdir(plan.folder.c_str(), 0700) != 0 && errno != EEXIST) {
    fail(v1::Error::FAILED, "cannot make the folder " + plan.folder.string() + ": " + std::strerror(errno));
  }
  std::vector<std::filesystem::path> files;
  std::vector<std::string> stems = {"authority", "server"};
  stems.insert(stems.end(), plan.clients.begin(), plan.clients.end());
  for (const std::string& stem : stems) {
    for (const char* ending : {".crt", ".key"}) {
      files.push_back(plan.folder / (stem + ending));
      if (std::filesystem::exists(std::filesystem::symlink_status(files.back()))) {
        fail(v1::Error::FAILED, files.back().string() + " is there already, and is not overwritten");
      }
    }
  }

  const Authority authority;
  save(plan.folder / "authority", authority.key.get(), authority.certificate.get());
  std::string names;
  for (const std::string& name : plan.server_names) {
    names += (names.empty() ? "" : ",") + std::string(is_ip(name) ? "IP:" : "DNS:") + name;
  }
  save_member(plan.folder / "server", authority, plan.server_names.front(), "serverAuth", names);
  for (const std::string& client : plan.clients) {
    save_member(plan.folder / client, authority, client, "clientAuth", "");
  }
  return files;
}

}  // namespace haptic::client
