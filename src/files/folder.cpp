#include "files/folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "heel/error.h"

namespace heel {

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  throw Error(fmt::format(
      "{}: cannot make this folder: {} (expected {})", folder, error.message(),
      error == std::errc::not_a_directory ? "a folder, not a file" : "a place where a folder can be made"));
}

}  // namespace heel
