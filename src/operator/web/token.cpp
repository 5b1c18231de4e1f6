#include "operator/web/token.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "heel/error.h"
#include "operator/web/limits.h"

namespace heel {
namespace {

/// The file of the credential; empty: the service was given none.
std::string credential_file() {
  const char* const folder = std::getenv("CREDENTIALS_DIRECTORY");
  if (folder == nullptr) return "";
  std::string file = std::string(folder) + "/view-token";
  struct stat status {};
  return stat(file.c_str(), &status) == 0 ? file : "";
}

Error token_error(const std::string& file, const std::string& what) {
  return Error(fmt::format("view.token_file: {}: {}", file, what));
}

}  // namespace

Token Token::read(const std::string& token_file) {
  const std::string file = token_file.empty() ? credential_file() : token_file;
  Token token;
  if (file.empty()) return token;
  struct stat status {};
  std::ifstream in(file, std::ios::binary);
  if (!in || stat(file.c_str(), &status) != 0)
    throw token_error(
        file, fmt::format("cannot be read: {} (expected a file with the token)", std::strerror(errno)));
  if ((status.st_mode & (S_IROTH | S_IWOTH)) != 0)
    throw token_error(
        file, "other users can read it or write to it (expected the mode 0640 or 0600: chmod o= FILE)");
  token.text_.resize(kMaxTokenBytes + 2);
  in.read(token.text_.data(), static_cast<std::streamsize>(token.text_.size()));
  token.text_.resize(static_cast<std::size_t>(in.gcount()));
  token.text_.erase(token.text_.find_last_not_of(" \t\r\n") + 1);
  if (token.text_.size() < kMinTokenBytes || token.text_.size() > kMaxTokenBytes)
    throw token_error(file, fmt::format("{} bytes (expected {} to {}: openssl rand -hex 16 > FILE)",
                                        token.text_.size(), kMinTokenBytes, kMaxTokenBytes));
  return token;
}

bool Token::equals(std::string_view text) const {
  if (!set()) return false;
  unsigned difference = text.size() == text_.size() ? 0u : 1u;
  for (std::size_t i = 0; i < text.size(); ++i)
    difference |= static_cast<unsigned char>(text[i] ^ text_[i % text_.size()]);
  return difference == 0;
}

}  // namespace heel
