#pragma once
// `hapticd simulate`: the tick of the service on a virtual clock, as fast as the machine allows, with forces
// armed from the start. Tick n is at n / rate; nothing depends on the time that passes meanwhile.

#include <iosfwd>
#include <string>

#include "simulate/tick_csv.h"

namespace haptic::simulate {

struct SimulateOptions {
  std::string config;
  std::string scene;      // empty: the one that the config names
  double duration = 0.0;  // s; every tick with n / rate <= duration is run
  CsvPaths csv{};
  std::string recording{};  // an MCAP file to write; empty: none
  bool verbose = false;     // the summary tells the transitions, too
};

/// Runs it and writes a summary to `summary`. Throws load::LoadError, drivers::DeviceError, OutputError.
void simulate(const SimulateOptions& options, std::ostream& summary);

}  // namespace haptic::simulate
