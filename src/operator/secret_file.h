// A secret that stands in a file of its own, or that systemd hands to the service: a token, a password.
#pragma once

#include <cstddef>
#include <string>

namespace heel {

struct SecretKind {
  std::string key;         ///< of the configuration, for messages: "view.token_file"
  std::string what;        ///< "token"
  std::string credential;  ///< its name as a credential of systemd: "view-token"
  std::size_t min_bytes = 1;
  std::size_t max_bytes = 512;
  std::string how_to_make;  ///< a hint behind the sizes; may be empty
};

/// Of the file, or, when its name is empty, of the credential; empty when that is missing, too. White space
/// at the end is no part of it. Throws heel::Error naming the file when it cannot be read, when other users
/// can, or when it is too short or too long.
std::string read_secret(const std::string& file, const SecretKind& kind);

}  // namespace heel
