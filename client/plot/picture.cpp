#include "client/plot/picture.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "client/lib/error.h"

namespace haptic::plot {
namespace {

constexpr int kNoProgram = 127;  // as a shell tells it

[[noreturn]] void fail(v1::Error::Code code, const std::string& message) {
  v1::Error error;
  error.set_code(code);
  error.set_message(message);
  client::throw_error(error);
}

// single quotes take everything but themselves, which are doubled, and ends of lines
std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    out += c == '\'' ? "''" : std::string(1, static_cast<unsigned char>(c) < ' ' ? ' ' : c);
  }
  return out + "'";
}

std::string data(const Series& series) {
  std::string out;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    out += std::isfinite(series.y[i]) ? fmt::format("{} {}\n", series.x[i], series.y[i]) : "\n";
  }
  return out;
}

const char* with(Picture::Style style) {
  switch (style) {
    case Picture::Style::kImpulses:
      return "impulses linewidth 4";
    case Picture::Style::kBars:
      return "boxes fill solid 0.7";
    case Picture::Style::kSteps:
      return "steps linewidth 1.5";
    default:
      return "lines linewidth 1.5";
  }
}

class File {
 public:
  explicit File(int descriptor) noexcept : descriptor_(descriptor) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { close(); }
  int get() const noexcept { return descriptor_; }
  void close() noexcept {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
      descriptor_ = -1;
    }
  }

 private:
  int descriptor_;
};

// all of it, unless the reader has gone
void write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) {
      return;
    }
    text.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
}

std::string contents(int descriptor) {
  std::string text;
  std::array<char, 4096> chunk{};
  ::lseek(descriptor, 0, SEEK_SET);
  for (ssize_t size = ::read(descriptor, chunk.data(), chunk.size()); size > 0;
       size = ::read(descriptor, chunk.data(), chunk.size())) {
    text.append(chunk.data(), static_cast<std::size_t>(size));
  }
  return text;
}

struct Outcome {
  int status = 0;     // as of a shell
  std::string words;  // on standard error
};

Outcome run_gnuplot(const std::string& program, int output) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    fail(v1::Error::FAILED, std::string("no pipe: ") + std::strerror(errno));
  }
  File from(pipe[0]);
  File to(pipe[1]);
  const File words(::memfd_create("gnuplot", MFD_CLOEXEC));
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(from.get(), STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(words.get(), STDERR_FILENO);
    ::execlp("gnuplot", "gnuplot", "-", nullptr);
    ::_exit(kNoProgram);
  }
  if (child < 0) {
    fail(v1::Error::FAILED, std::string("gnuplot cannot be started: ") + std::strerror(errno));
  }
  from.close();
  // a gnuplot that ends early is no reason to end with it
  const auto before = ::signal(SIGPIPE, SIG_IGN);
  write_all(to.get(), program);
  to.close();
  ::signal(SIGPIPE, before);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return {.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1, .words = contents(words.get())};
}

// what gnuplot says, without the lines that only show where
std::string reason(const std::string& words) {
  std::string out;
  std::size_t begin = 0;
  while (begin < words.size()) {
    const std::size_t end = std::min(words.find('\n', begin), words.size());
    const std::string_view line = std::string_view(words).substr(begin, end - begin);
    const bool is_mark =
        line.find_first_not_of(" \t^") == std::string_view::npos || line.starts_with("gnuplot>");
    if (!is_mark) {
      out += (out.empty() ? "" : "; ") + std::string(line.substr(line.find_first_not_of(" \t")));
    }
    begin = end + 1;
  }
  return out.empty() ? "it gives no reason" : out;
}

}  // namespace

Series thinned(const Series& series, std::size_t points) {
  const std::size_t parts = std::max<std::size_t>(points / 2, 1);
  if (series.x.size() <= 2 * parts) {
    return series;
  }
  Series out{.name = series.name, .x = {}, .y = {}};
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = series.x.size() * part / parts;
    const std::size_t end = series.x.size() * (part + 1) / parts;
    std::size_t least = begin;
    std::size_t greatest = begin;
    for (std::size_t i = begin; i < end; ++i) {
      least = std::isnan(series.y[least]) || series.y[i] < series.y[least] ? i : least;
      greatest = std::isnan(series.y[greatest]) || series.y[i] > series.y[greatest] ? i : greatest;
    }
    for (const std::size_t i : {std::min(least, greatest), std::max(least, greatest)}) {
      out.x.push_back(series.x[i]);
      out.y.push_back(series.y[i]);
      if (least == greatest) {
        break;
      }
    }
  }
  return out;
}

std::string script(const Picture& picture, const std::string& terminal, Size size) {
  std::string out =
      fmt::format("set terminal {} size {},{} noenhanced font 'sans-serif,12' background '#ffffff'\n",
                  terminal, size.width, size.height);
  out += "set title " + quoted(picture.title) + "\nset xlabel " + quoted(picture.x_axis) + "\nset ylabel " +
         quoted(picture.y_axis) + "\nset grid linecolor '#dddddd'\nset key top right\n";
  out += picture.log_x ? "set logscale x\n" : "";
  out += picture.log_y ? "set logscale y\n" : "set yrange [0:*]\n";
  if (picture.style == Picture::Style::kBars) {
    out += "set boxwidth 0.8\nset offsets 0.5,0.5,0,0\n";
  }
  for (std::size_t i = 0; i < picture.labels.size(); ++i) {
    out += fmt::format("set xtics {} ({} {}) rotate by -45\n", i == 0 ? "" : "add", quoted(picture.labels[i]),
                       i);
  }
  for (std::size_t i = 0; i < picture.series.size(); ++i) {
    out += fmt::format("$data{} << END_OF_DATA\n{}END_OF_DATA\n", i, data(picture.series[i]));
  }
  out += "plot ";
  for (std::size_t i = 0; i < picture.series.size(); ++i) {
    const std::string& name = picture.series[i].name;
    out += fmt::format("{}$data{} using 1:2 with {} {}", i == 0 ? "" : ", ", i, with(picture.style),
                       name.empty() ? "notitle" : "title " + quoted(name));
  }
  return out + "\n";
}

void draw(const Picture& picture, const std::string& path, Size size) {
  const bool is_svg = path.ends_with(".svg");
  if (!is_svg && !path.ends_with(".png")) {
    fail(v1::Error::INVALID, path + ": a picture's name ends in .svg or .png");
  }
  const bool is_empty = std::all_of(picture.series.begin(), picture.series.end(), [](const Series& series) {
    return std::none_of(series.y.begin(), series.y.end(), [](double y) { return std::isfinite(y); });
  });
  if (is_empty) {
    fail(v1::Error::FAILED, "there is nothing to draw");
  }
  const std::string unfinished = path + ".part";
  const File output(::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (output.get() < 0) {
    fail(v1::Error::FAILED, path + ": " + std::strerror(errno));
  }
  const Outcome outcome = run_gnuplot(script(picture, is_svg ? "svg" : "pngcairo", size), output.get());
  if (outcome.status == 0 && std::rename(unfinished.c_str(), path.c_str()) == 0) {
    return;
  }
  ::unlink(unfinished.c_str());
  fail(v1::Error::FAILED, outcome.status == kNoProgram
                              ? "there is no gnuplot; Debian's package is gnuplot-nox"
                          : outcome.status == 0 ? path + " cannot be written"
                                                : "gnuplot: " + reason(outcome.words));
}

}  // namespace haptic::plot
