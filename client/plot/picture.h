#pragma once
// A picture of curves or bars, and how gnuplot draws it.

#include <string>
#include <vector>

namespace haptic::plot {

/// Points in the order in which they are joined. A y that is no number breaks the line.
struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

struct Picture {
  std::string title;
  std::string x_axis;  // with the unit
  std::string y_axis;
  enum class Style { kLines, kImpulses, kBars, kSteps } style = Style::kLines;
  bool log_x = false;
  bool log_y = false;
  std::vector<std::string> labels;  // of bars, at 0, 1, ...; none: numbers
  std::vector<Series> series;
};

struct Size {
  unsigned width = 720;  // pixels
  unsigned height = 400;
};

/// The same curve with at most some `points` points: in each of equal parts its least and its greatest value
/// stay, so that no tooth is lost.
Series thinned(const Series& series, std::size_t points);

/// What gnuplot is told. `terminal`: "svg" or "pngcairo". Names may hold anything.
std::string script(const Picture& picture, const std::string& terminal, Size size);

/// Writes the picture to a file that ends in .svg or .png; one that is there is replaced when the new one is
/// whole. Runs gnuplot. Throws client::Invalid for another ending, client::Error with gnuplot's own words if
/// it fails.
void draw(const Picture& picture, const std::string& path, Size size);

}  // namespace haptic::plot
