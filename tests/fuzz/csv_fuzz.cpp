// Tables from CSV for pictures: what is accepted has cells in every row, and numbers are finite. What can be
// drawn of it makes a script whose data are numbers alone.

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "client/lib/error.h"
#include "client/plot/curves.h"
#include "client/plot/forces.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  try {
    std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
    const plot::Csv table = plot::Csv::parse(text, "f");
    const std::size_t time = table.column("time");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (!std::isfinite(table.number(row, time))) std::abort();
    }
    const plot::Picture picture = plot::force(plot::forces_of(table, plot::first_of(table)));
    for (const plot::Series& series : picture.series) {
      if (series.x.size() != series.y.size() || series.x.empty()) std::abort();
    }
    const std::string script = plot::script(picture, "svg", {});
    const std::size_t plot_line = script.rfind("\nplot ");
    if (plot_line == std::string::npos || script.find('\n', plot_line + 1) != script.size() - 1) std::abort();
    if (table.has("finger")) plot::hips(plot::hip_forces_of(table, 0.0));
  } catch (const client::Error&) {
    return 0;
  }
  return 0;
}
