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

}  // namespace

void Redaction::add_word(const std::string& name, const std::string& instead) {
  if (!name.empty()) words_.emplace_back(name, instead);
}

std::string Redaction::applied(std::string_view text) const {
  std::string result = with_name_behind_replaced(std::string(text), "/home/", "USER");
  result = with_name_behind_replaced(std::move(result), "/by-id/", "DEVICE");
  for (const auto& [word, instead] : words_) result = with_word_replaced(std::move(result), word, instead);
  return result;
}

}  // namespace heel
