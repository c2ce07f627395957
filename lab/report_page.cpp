#include "lab/report_page.h"

#include "base/program.h"
#include "lab/child_process.h"
#include "lab/lab_error.h"

#include <string>
#include <vector>

namespace atlaswire::lab {
namespace {

/// Runs it to its end.
int run(ChildProcess& process) {
  while (!process.ended()) wait_for_any({&process}, std::chrono::milliseconds(200));
  return *process.ended();
}

/// The first Python that has matplotlib; Debian's own has it, another may come first on PATH. Empty: none.
std::string plotting_python() {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    try {
      ChildProcess probe({python, "-c", "import matplotlib"});
      if (run(probe) == 0) return python;
    } catch (const ProgramError&) {
      continue;  // not installed
    }
  }
  return {};
}

}  // namespace

Result<void> make_report(const std::filesystem::path& folder) {
  const std::filesystem::path script =
      std::filesystem::path(own_program()).parent_path().parent_path() / "share" / "atlas-lab" / "report.py";
  if (!std::filesystem::exists(script))
    return Error{LabError::kNotFound, "the report's script " + script.string()};
  const std::string python = plotting_python();
  if (python.empty()) {
    return Error{LabError::kNotFound, "a python3 with matplotlib (install python3-matplotlib)"};
  }
  ChildProcess process({python, "-B", script.string(), folder.string()});
  if (run(process) != 0) return Error{LabError::kNotFound, "report.py: " + last_line(process.error_text())};
  return {};
}

}  // namespace atlaswire::lab
