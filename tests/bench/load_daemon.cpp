#include "tests/bench/load_daemon.h"

#include <google/protobuf/text_format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "client/lib/connection.h"
#include "client/lib/error.h"
#include "load/config_file.h"

namespace haptic::bench {
namespace {

constexpr std::uint32_t kCrowd = 512;  // clients, all of one user

// the config with room for a crowd; in another folder, so that its paths must be whole
std::string with_room(const std::string& config) {
  v1::DaemonConfig message = load::load_config(std::filesystem::absolute(config)).message;
  message.mutable_limits()->set_clients(kCrowd);
  message.mutable_limits()->set_clients_per_user(kCrowd);
  std::string text;
  google::protobuf::TextFormat::PrintToString(message, &text);
  return text;
}

}  // namespace

LoadDaemon::LoadDaemon(const std::string& program, const std::string& config)
    : socket_(folder_.file("hapticd.sock")) {
  const std::string file = folder_.write("load.txtpb", with_room(config));
  process_ = ::fork();
  if (process_ == 0) {
    ::execl(program.c_str(), program.c_str(), "run", "--config", file.c_str(), "--socket", socket_.c_str(),
            nullptr);
    ::_exit(127);
  }
  for (int attempt = 0; attempt < 100; ++attempt) {
    try {
      stats(false);
      return;
    } catch (const client::Error&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  throw std::runtime_error(program + " does not answer");
}

LoadDaemon::~LoadDaemon() {
  ::kill(process_, SIGTERM);
  ::waitpid(process_, nullptr, 0);
}

v1::Response LoadDaemon::call(const v1::Request& request) const {
  client::Options options;
  options.address = socket_;
  options.program = "load_bench";
  client::Connection daemon(options);
  return daemon.call(request);
}

v1::Stats LoadDaemon::stats(bool reset) const {
  v1::Request request;
  request.mutable_get_stats()->set_reset(reset);
  return call(request).stats();
}

std::uint64_t LoadDaemon::missed_ticks() const {
  v1::Request request;
  request.mutable_get_status();
  return call(request).status().missed_ticks();
}

double cpu_seconds_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(file, line);
  // after the name, which may hold anything: state is field 3, utime and stime are 14 and 15
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string skipped;
  for (int field = 3; field < 14; ++field) {
    fields >> skipped;
  }
  double user = 0.0;
  double system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace haptic::bench
