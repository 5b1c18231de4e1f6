#include "operator/secret_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "heel/error.h"

namespace heel {
namespace {

/// The file of the credential; empty: the service was given none.
std::string credential_file(const std::string& name) {
  const char* const folder = std::getenv("CREDENTIALS_DIRECTORY");
  if (folder == nullptr) return "";
  std::string file = std::string(folder) + "/" + name;
  struct stat status {};
  return stat(file.c_str(), &status) == 0 ? file : "";
}

}  // namespace

std::string read_secret(const std::string& configured_file, const SecretKind& kind) {
  const std::string file = configured_file.empty() ? credential_file(kind.credential) : configured_file;
  if (file.empty()) return "";
  const auto error = [&](const std::string& what) {
    return Error(fmt::format("{}: {}: {}", kind.key, file, what));
  };
  struct stat status {};
  std::ifstream in(file, std::ios::binary);
  if (!in || stat(file.c_str(), &status) != 0)
    throw error(
        fmt::format("cannot be read: {} (expected a file with the {})", std::strerror(errno), kind.what));
  if ((status.st_mode & (S_IROTH | S_IWOTH)) != 0)
    throw error("other users can read it or write to it (expected the mode 0640 or 0600: chmod o= FILE)");
  std::string text(kind.max_bytes + 2, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  if (text.size() < kind.min_bytes || text.size() > kind.max_bytes)
    throw error(fmt::format("{} bytes (expected {} to {}{}{})", text.size(), kind.min_bytes, kind.max_bytes,
                            kind.how_to_make.empty() ? "" : ": ", kind.how_to_make));
  return text;
}

}  // namespace heel
