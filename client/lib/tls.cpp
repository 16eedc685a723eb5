#include "client/lib/tls.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <array>
#include <functional>
#include <utility>

#include "client/lib/address.h"
#include "client/lib/error.h"

namespace haptic::client {
namespace {

using Outcome = StreamSocket::Outcome;

std::string take_reason() {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  const char* const reason = code == 0 ? nullptr : ERR_reason_error_string(code);
  return reason == nullptr ? "" : reason;
}

[[noreturn]] void throw_invalid(const std::string& message) {
  v1::Error error;
  error.set_code(v1::Error::INVALID);
  error.set_message(message);
  throw Invalid(error);
}

void use_file(const char* what, const std::string& file, const std::function<int(const char*)>& use) {
  if (file.empty()) {
    throw_invalid(std::string("TLS needs a certificate, its key and an authority; the ") + what +
                  " is missing");
  }
  ERR_clear_error();
  if (use(file.c_str()) != 1) {
    throw_invalid(std::string("cannot use ") + file + " as the " + what + ": " + take_reason());
  }
}

}  // namespace

// the bytes go through memory, and the socket's own calls carry them: with their deadlines, and no SIGPIPE
class Tls::Impl {
 public:
  Impl(const Identity& identity, std::string server) : server_(std::move(server)) {
    SSL_CTX* const context = context_.get();
    SSL_CTX_set_min_proto_version(context, TLS1_3_VERSION);
    SSL_CTX_set_verify(context, SSL_VERIFY_PEER, nullptr);
    use_file("certificate", identity.certificate,
             [&](const char* file) { return SSL_CTX_use_certificate_chain_file(context, file); });
    use_file("key", identity.key,
             [&](const char* file) { return SSL_CTX_use_PrivateKey_file(context, file, SSL_FILETYPE_PEM); });
    use_file("authority", identity.authority,
             [&](const char* file) { return SSL_CTX_load_verify_locations(context, file, nullptr); });
    ssl_.reset(SSL_new(context));
    in_ = BIO_new(BIO_s_mem());
    out_ = BIO_new(BIO_s_mem());
    SSL_set_bio(ssl_.get(), in_, out_);  // which owns them now
    if (is_ip(server_)) {
      X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl_.get()), server_.c_str());
    } else {
      SSL_set1_host(ssl_.get(), server_.c_str());
      SSL_set_tlsext_host_name(ssl_.get(), server_.c_str());
    }
  }

  void handshake(StreamSocket& socket, Clock::time_point deadline) {
    while (true) {
      ERR_clear_error();
      const int result = SSL_connect(ssl_.get());
      const int error = SSL_get_error(ssl_.get(), result);
      // also what tells the server why not
      const Outcome flushed = flush(socket, deadline);
      if (result == 1 && flushed == Outcome::kDone) {
        return;
      }
      if (result != 1 && error != SSL_ERROR_WANT_READ) {
        throw Unreachable("cannot trust the daemon at " + server_ + ": " + why_not());
      }
      const Outcome outcome = flushed == Outcome::kDone ? feed(socket, deadline) : flushed;
      if (outcome == Outcome::kTimedOut) {
        throw Unreachable("what listens at " + server_ + " did not answer with TLS in time");
      }
      if (outcome == Outcome::kClosed) {
        throw Unreachable("what listens at " + server_ + " closed the connection before TLS was agreed on");
      }
    }
  }

  Outcome send(StreamSocket& socket, std::string_view bytes, Clock::time_point deadline) {
    ERR_clear_error();
    if (SSL_write(ssl_.get(), bytes.data(), static_cast<int>(bytes.size())) <= 0) {
      problem_ = take_reason();
      return Outcome::kClosed;
    }
    return flush(socket, deadline);
  }

  Outcome receive(StreamSocket& socket, std::span<char> buffer, std::size_t& received,
                  Clock::time_point deadline) {
    while (true) {
      ERR_clear_error();
      const int got = SSL_read(ssl_.get(), buffer.data(), static_cast<int>(buffer.size()));
      if (got > 0) {
        received = static_cast<std::size_t>(got);
        return Outcome::kDone;
      }
      if (SSL_get_error(ssl_.get(), got) != SSL_ERROR_WANT_READ) {
        problem_ = take_reason();
        return Outcome::kClosed;
      }
      Outcome outcome = flush(socket, deadline);
      outcome = outcome == Outcome::kDone ? feed(socket, deadline) : outcome;
      if (outcome != Outcome::kDone) {
        return outcome;
      }
    }
  }

  const std::string& problem() const noexcept { return problem_; }

 private:
  Outcome flush(StreamSocket& socket, Clock::time_point deadline) {
    while (const auto size = BIO_read(out_, chunk_.data(), static_cast<int>(chunk_.size()))) {
      if (size < 0) {
        break;  // empty
      }
      const Outcome outcome =
          socket.send(std::string_view(chunk_.data(), static_cast<std::size_t>(size)), deadline);
      if (outcome != Outcome::kDone) {
        return outcome;
      }
    }
    return Outcome::kDone;
  }

  Outcome feed(StreamSocket& socket, Clock::time_point deadline) {
    std::size_t size = 0;
    const Outcome outcome = socket.receive(chunk_, size, deadline);
    if (outcome == Outcome::kDone) {
      BIO_write(in_, chunk_.data(), static_cast<int>(size));
    }
    return outcome;
  }

  std::string why_not() {
    const long verdict = SSL_get_verify_result(ssl_.get());
    const std::string reason = take_reason();
    return verdict == X509_V_OK ? reason : X509_verify_cert_error_string(verdict);
  }

  std::string server_;
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_{SSL_CTX_new(TLS_client_method()), &SSL_CTX_free};
  std::unique_ptr<SSL, decltype(&SSL_free)> ssl_{nullptr, &SSL_free};
  BIO* in_ = nullptr;
  BIO* out_ = nullptr;
  std::array<char, 16384> chunk_{};
  std::string problem_;
};

Tls::Tls(const Identity& identity, const std::string& server)
    : impl_(std::make_unique<Impl>(identity, server)) {}
Tls::Tls(Tls&&) noexcept = default;
Tls& Tls::operator=(Tls&&) noexcept = default;
Tls::~Tls() = default;

void Tls::handshake(StreamSocket& socket, Clock::time_point deadline) { impl_->handshake(socket, deadline); }
Outcome Tls::send(StreamSocket& socket, std::string_view bytes, Clock::time_point deadline) {
  return impl_->send(socket, bytes, deadline);
}
Outcome Tls::receive(StreamSocket& socket, std::span<char> buffer, std::size_t& received,
                     Clock::time_point deadline) {
  return impl_->receive(socket, buffer, received, deadline);
}
const std::string& Tls::problem() const noexcept { return impl_->problem(); }

}  // namespace haptic::client
