#include "client/cli/screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace haptic::cli {
namespace {

volatile std::sig_atomic_t stop = 0;

void request_stop(int signal) { stop = signal; }

void write_all(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace

bool is_terminal() noexcept { return ::isatty(STDOUT_FILENO) == 1; }

void catch_stop_signals() noexcept {
  struct sigaction action {};
  action.sa_handler = request_stop;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() noexcept { return stop != 0; }
int stop_signal() noexcept { return stop; }

// alternate screen, no cursor; and back
Screen::Screen() { write_all("\033[?1049h\033[?25l\033[2J"); }
Screen::~Screen() { write_all("\033[?25h\033[?1049l"); }

void Screen::show(const std::string& text) {
  winsize window{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_row == 0) {
    window.ws_row = 24;
    window.ws_col = 80;
  }
  // home; the text; erase what is below it
  write_all("\033[H" + fit(text, window.ws_row, window.ws_col) + "\033[J");
}

std::string fit(const std::string& text, std::size_t rows, std::size_t columns) {
  std::string out;
  std::size_t start = 0;
  for (std::size_t row = 0; row < rows && start < text.size(); ++row) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    out += row == 0 ? "" : "\r\n";
    std::size_t used = 0;
    for (std::size_t i = start; i < end; ++i) {
      const bool continues = (static_cast<unsigned char>(text[i]) & 0xc0U) == 0x80U;
      used += continues ? 0 : 1;
      if (used > columns) {
        break;
      }
      out += text[i];
    }
    out += "\033[K";
    start = end + 1;
  }
  return out;
}

}  // namespace haptic::cli
