#include "ipc/stream.h"

#include <boost/asio/write.hpp>

namespace haptic::ipc {
namespace {

class PlainStream final : public Stream {
 public:
  explicit PlainStream(Socket socket) : socket_(std::move(socket)) {}

  void read_some(boost::asio::mutable_buffer buffer, OnBytes on_bytes) override {
    socket_.async_read_some(buffer, std::move(on_bytes));
  }
  void write(const std::vector<boost::asio::const_buffer>& buffers, OnBytes on_bytes) override {
    boost::asio::async_write(socket_, buffers, std::move(on_bytes));
  }
  void end_writing() override {
    boost::system::error_code ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
  }
  void close() noexcept override {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }
  Socket::executor_type executor() override { return socket_.get_executor(); }

 private:
  Socket socket_;
};

}  // namespace

std::shared_ptr<Stream> make_plain_stream(Stream::Socket socket) {
  return std::make_shared<PlainStream>(std::move(socket));
}

}  // namespace haptic::ipc
