#include "capture/factory/camera_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "heel/error.h"

namespace heel {

std::unique_ptr<FrameSource> source_of_module(const std::string& kind, const std::string& rest,
                                              const CameraConfig& config) {
  // Not by $ORIGIN, which the loader does not follow in a program with file capabilities.
  const std::filesystem::path programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string file = programs / HEEL_MODULES_FROM_PROGRAMS / ("camera-" + kind + ".so");
  // Never unloaded: a source may have left threads and handlers of its libraries.
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const entry = module == nullptr ? nullptr : dlsym(module, kCameraModuleEntry);
  if (entry == nullptr) {
    const char* const problem = dlerror();
    throw Error(
        fmt::format("camera address '{}': its module cannot be loaded: {} (expected it where heel is "
                    "installed; install the package again)",
                    config.source, problem == nullptr ? "no reason given" : problem));
  }
  return std::unique_ptr<FrameSource>(reinterpret_cast<CameraModuleEntry*>(entry)(rest, config));
}

}  // namespace heel
