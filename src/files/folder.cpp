#include "files/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "heel/error.h"

namespace heel {

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) {
    // AT_EACCESS: by the ids that open() will check.
    if (faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return;
    throw Error(fmt::format("{}: cannot write into this folder: {} (expected one that this user can write)",
                            folder, std::strerror(errno)));
  }
  throw Error(fmt::format(
      "{}: cannot make this folder: {} (expected {})", folder, error.message(),
      error == std::errc::not_a_directory ? "a folder, not a file" : "a place where a folder can be made"));
}

}  // namespace heel
