#pragma once
// A program as a shell runs it.

#include <stdio.h>
#include <sys/wait.h>

#include <string>

namespace haptic::test {

struct Finished {
  int code = -1;
  std::string output;  // with errors
};

inline Finished run_program(const std::string& command) {
  FILE* pipe = ::popen(("{ " + command + "; } 2>&1").c_str(), "r");
  Finished result;
  char chunk[4096];
  while (const std::size_t size = ::fread(chunk, 1, sizeof(chunk), pipe)) {
    result.output.append(chunk, size);
  }
  const int status = ::pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace haptic::test
