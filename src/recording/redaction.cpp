#include "recording/redaction.h"

#include <algorithm>
#include <cctype>

namespace heel {
namespace {

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string with_word_replaced(std::string text, const std::string& word, const std::string& instead) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    const std::size_t end = at + word.size();
    const bool is_word = (at == 0 || !is_word_character(text[at - 1])) &&
                         (end == text.size() || !is_word_character(text[end]));
    if (is_word) text.replace(at, word.size(), instead);
    at += is_word ? instead.size() : 1;
  }
  return text;
}

/// What follows the prefix, up to the end of the file's name.
std::string with_name_behind_replaced(std::string text, std::string_view prefix, std::string_view instead) {
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
    at += prefix.size();
    const std::size_t end = std::min(text.find_first_of("/\" \n\t'\\,;@", at), text.size());
    text.replace(at, end - at, instead);
  }
  return text;
}

/// The host of "tcp:HOST:PORT" and "ssl://HOST:PORT"; one in brackets has colons itself.
std::string with_hosts_replaced(std::string text, std::string_view prefix) {
  constexpr std::string_view kHost = "HOST";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
    at += prefix.size();
    const bool brackets = at < text.size() && text[at] == '[';
    const std::size_t end = brackets ? text.find(']', at) + 1 : text.find_first_of(":/\" \n\t'\\,;@()", at);
    if (end == std::string::npos || end <= at || text[end] != ':') continue;
    text.replace(at, end - at, kHost);
  }
  return text;
}

}  // namespace

void Redaction::add_word(const std::string& name, const std::string& instead) {
  if (!name.empty()) words_.emplace_back(name, instead);
}

std::string Redaction::applied(std::string_view text) const {
  std::string result = with_name_behind_replaced(std::string(text), "/home/", "USER");
  result = with_name_behind_replaced(std::move(result), "/by-id/", "DEVICE");
  for (const char* prefix : {"tcp:", "tcp://", "ssl://"})
    result = with_hosts_replaced(std::move(result), prefix);
  for (const auto& [word, instead] : words_) result = with_word_replaced(std::move(result), word, instead);
  return result;
}

std::string Redaction::applied_to_toml(std::string_view toml) const {
  std::string result;
  for (std::size_t at = 0; at < toml.size();) {
    const std::size_t begin = std::min(toml.find_first_of("\"'#", at), toml.size());
    result += toml.substr(at, begin - at);
    if (begin == toml.size()) break;
    const char quote = toml[begin];
    std::size_t end = begin + 1;
    const char last = quote == '#' ? '\n' : quote;
    for (; end < toml.size() && toml[end] != last && toml[end] != '\n'; ++end)
      if (quote == '"' && toml[end] == '\\') ++end;
    end = std::min(end, toml.size());
    const std::string_view inside = toml.substr(begin + 1, end - begin - 1);
    const bool names = quote == '#' || inside.find_first_of("/:@.") != std::string_view::npos;
    const bool user = quote != '#' && !inside.empty() && result.ends_with("\nuser = ");
    result += quote;
    result += user ? "USER" : names ? applied(inside) : std::string(inside);
    if (end < toml.size()) result += toml[end];
    at = end + 1;
  }
  return result;
}

}  // namespace heel
