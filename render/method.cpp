#include "render/method.h"

#include "base/program.h"
#include "render/sas/sas_method.h"
#include "render/video/video_method.h"

#include <array>

namespace atlaswire::render {
namespace {

using Maker = std::unique_ptr<Method> (*)(Device&, std::shared_ptr<const Scene>, const MethodSettings&);

struct Registration {
  const char* name;
  Maker make;
};

template <class Kind>
std::unique_ptr<Method> make(Device& device, std::shared_ptr<const Scene> scene,
                             const MethodSettings& settings) {
  return std::make_unique<Kind>(device, std::move(scene), settings);
}

/// One line a method.
const std::array kMethods{Registration{"sas", make<SasMethod>}, Registration{"video", make<VideoMethod>}};

}  // namespace

std::unique_ptr<Method> make_method(const std::string& name, Device& device,
                                    std::shared_ptr<const Scene> scene, const MethodSettings& settings) {
  std::string known;
  for (const Registration& method : kMethods) {
    if (name == method.name) return method.make(device, std::move(scene), settings);
    known += (known.empty() ? "" : ", ") + std::string(method.name);
  }
  throw ProgramError(ExitCode::kUsage, "unknown method '" + name + "': choose one of " + known);
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Registration& method : kMethods) names.emplace_back(method.name);
  return names;
}

}  // namespace atlaswire::render
