#include "base/log.h"
#include "base/program.h"
#include "client/settings.h"
#include "client/viewer.h"

#include <cstdio>

namespace {

int body(int argc, char** argv) {
  const atlaswire::client::Options options = atlaswire::client::parse_options(argc, argv);
  if (!options.run) {
    std::fputs(options.text.c_str(), stdout);
    return 0;
  }
  atlaswire::set_up_logging("atlas-client", options.settings.log);
  return static_cast<int>(atlaswire::client::run_viewer(options.settings));
}

}  // namespace

int main(int argc, char** argv) { return atlaswire::run_program("atlas-client", argc, argv, body); }
