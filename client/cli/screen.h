#pragma once
// The terminal while something is shown live in it: a screen of its own, given back on every way out.

#include <string>

namespace haptic::cli {

/// Whether standard output is a terminal.
bool is_terminal() noexcept;

/// SIGINT and SIGTERM end what runs instead of killing the program: blocking calls return, stop_requested()
/// turns true. Without SA_RESTART.
void catch_stop_signals() noexcept;
bool stop_requested() noexcept;
/// Which of the two it was; 0 before.
int stop_signal() noexcept;

class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Shows the text from the top; lines and rows that the window has no room for are cut. One write, so that
  /// nothing flickers.
  void show(const std::string& text);
};

/// The text cut to so many rows and columns, each line followed by "erase to the end of the line".
std::string fit(const std::string& text, std::size_t rows, std::size_t columns);

}  // namespace haptic::cli
