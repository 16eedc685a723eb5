#include "ipc/tls.h"

#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <string_view>

#include "ipc/listen_socket.h"

namespace haptic::ipc {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

// what is under way refers to the stream, so each handler keeps it alive
class TlsStream final : public Stream, public std::enable_shared_from_this<TlsStream> {
 public:
  TlsStream(Socket socket, asio::ssl::context& context)
      : stream_(std::move(socket), context), timer_(stream_.get_executor()) {}

  void handshake(std::chrono::milliseconds limit, std::function<void(const error_code&)> on_end) {
    timer_.expires_after(limit);
    timer_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error) {
        self->close();
      }
    });
    stream_.async_handshake(asio::ssl::stream_base::server,
                            [self = shared_from_this(), on_end = std::move(on_end)](const error_code& error) {
                              self->timer_.cancel();
                              on_end(error);
                            });
  }

  SSL* native() { return stream_.native_handle(); }

  void read_some(asio::mutable_buffer buffer, OnBytes on_bytes) override {
    stream_.async_read_some(buffer,
                            [self = shared_from_this(), on_bytes = std::move(on_bytes)](
                                const error_code& error, std::size_t size) { on_bytes(error, size); });
  }
  void write(const std::vector<asio::const_buffer>& buffers, OnBytes on_bytes) override {
    asio::async_write(stream_, buffers,
                      [self = shared_from_this(), on_bytes = std::move(on_bytes)](
                          const error_code& error, std::size_t size) { on_bytes(error, size); });
  }
  void end_writing() override {
    stream_.async_shutdown([self = shared_from_this()](const error_code&) {});
  }
  void close() noexcept override {
    error_code ignored;
    stream_.lowest_layer().close(ignored);
  }
  Socket::executor_type executor() override { return stream_.get_executor(); }

 private:
  asio::ssl::stream<Socket> stream_;
  asio::steady_timer timer_;  // for the handshake
};

// nothing if there is a zero byte within: such a name looks like another one
void add_name(const ASN1_STRING* text, std::vector<std::string>& names) {
  unsigned char* bytes = nullptr;
  const int size = ASN1_STRING_to_UTF8(&bytes, text);
  if (size < 0) {
    return;
  }
  const std::string name(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  OPENSSL_free(bytes);
  if (!name.empty() && name.find('\0') == std::string::npos) {
    names.push_back(name);
  }
}

std::vector<std::string> names_in(X509* certificate) {
  std::vector<std::string> names;
  const X509_NAME* const subject = X509_get_subject_name(certificate);
  for (int at = X509_NAME_get_index_by_NID(subject, NID_commonName, -1); at >= 0;
       at = X509_NAME_get_index_by_NID(subject, NID_commonName, at)) {
    add_name(X509_NAME_ENTRY_get_data(X509_NAME_get_entry(subject, at)), names);
  }
  const std::unique_ptr<GENERAL_NAMES, decltype(&GENERAL_NAMES_free)> others(
      static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)),
      &GENERAL_NAMES_free);
  for (int i = 0; others && i < sk_GENERAL_NAME_num(others.get()); ++i) {
    const GENERAL_NAME* const other = sk_GENERAL_NAME_value(others.get(), i);
    if (other->type == GEN_DNS) {
      add_name(other->d.dNSName, names);
    }
  }
  return names;
}

void warn_if_open(const std::string& key) {
  struct stat status {};
  if (::stat(key.c_str(), &status) == 0 && (status.st_mode & 0077U) != 0) {
    spdlog::warn("listen.tcp.tls.key: others than its owner can use {}; make it private: chmod 600", key);
  }
}

}  // namespace

class TlsContext::Impl {
 public:
  asio::ssl::context context{asio::ssl::context::tls_server};
};

TlsContext::TlsContext(const v1::Listen::Tls& config) : impl_(std::make_unique<Impl>()) {
  asio::ssl::context& context = impl_->context;
  SSL_CTX* const native = context.native_handle();
  SSL_CTX_set_min_proto_version(native, TLS1_3_VERSION);
  SSL_CTX_set_session_cache_mode(native, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_num_tickets(native, 0);  // each connection shows its certificate anew
  context.set_verify_mode(asio::ssl::verify_peer | asio::ssl::verify_fail_if_no_peer_cert);

  const auto read = [](const char* field, const std::string& file, const error_code& error) {
    if (error) {
      throw ListenError("listen.tcp.tls." + std::string(field) + ": cannot use " + file + ": " +
                        error.message());
    }
  };
  error_code error;
  context.use_certificate_chain_file(config.certificate(), error);
  read("certificate", config.certificate(), error);
  context.use_private_key_file(config.key(), asio::ssl::context::pem, error);
  read("key", config.key(), error);
  context.load_verify_file(config.authority(), error);
  read("authority", config.authority(), error);
  SSL_CTX_set_client_CA_list(native, SSL_load_client_CA_file(config.authority().c_str()));
  warn_if_open(config.key());
}

TlsContext::~TlsContext() = default;

void TlsContext::handshake(Stream::Socket socket, std::chrono::milliseconds limit, OnPeer on_peer) {
  const auto stream = std::make_shared<TlsStream>(std::move(socket), impl_->context);
  stream->handshake(limit, [stream, on_peer = std::move(on_peer)](const error_code& error) {
    if (error) {
      stream->close();
      on_peer({},
              error == asio::error::operation_aborted ? "no TLS handshake came in time" : error.message());
      return;
    }
    const std::unique_ptr<X509, decltype(&X509_free)> certificate(SSL_get1_peer_certificate(stream->native()),
                                                                  &X509_free);
    on_peer({stream, certificate ? names_in(certificate.get()) : std::vector<std::string>()}, "");
  });
}

}  // namespace haptic::ipc
