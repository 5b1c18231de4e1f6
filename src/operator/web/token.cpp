#include "operator/web/token.h"

#include "operator/secret_file.h"
#include "operator/web/limits.h"

namespace heel {

Token Token::read(const std::string& token_file) {
  Token token;
  token.text_ = read_secret(token_file, {.key = "view.token_file",
                                         .what = "token",
                                         .credential = "view-token",
                                         .min_bytes = kMinTokenBytes,
                                         .max_bytes = kMaxTokenBytes,
                                         .how_to_make = "openssl rand -hex 16 > FILE"});
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
