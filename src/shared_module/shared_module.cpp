#include "shared_module/shared_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "heel/error.h"

namespace heel {

void* module_entry(const std::string& name, const char* entry, const std::string& asked_by) {
  // Not by $ORIGIN, which the loader does not follow in a program with file capabilities.
  const std::filesystem::path programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string file = programs / HEEL_MODULES_FROM_PROGRAMS / (name + ".so");
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = module == nullptr ? nullptr : dlsym(module, entry);
  if (function != nullptr) return function;
  const char* const problem = dlerror();
  throw Error(
      fmt::format("{}: its module cannot be loaded: {} (expected it where heel is installed; install the "
                  "package again)",
                  asked_by, problem == nullptr ? "no reason given" : problem));
}

}  // namespace heel
