// Libraries that would burden every heeld, although few use them: FFmpeg and OpenCV for files (60 MB of
// memory), libcamera with its tracing threads (25 MB), Paho with OpenSSL. What calls them is a module, a
// shared object beside the programs (cmake/HeelModules.cmake), that is loaded when the configuration asks for
// it.
#pragma once

#include <string>

namespace heel {

/// The address of the function `entry` of the module NAME.so. The module is never unloaded, because its
/// libraries may leave threads and handlers. `asked_by`: the key and value that need it. Throws heel::Error,
/// which begins with `asked_by` and names the module's file, when it cannot be loaded.
void* module_entry(const std::string& name, const char* entry, const std::string& asked_by);

}  // namespace heel
