// Strict reading of one TOML table: every key has a type and a range, and a key nobody asked for is an error.
// Complaints read "FILE:LINE:COLUMN: KEY: found (expected …)".
#pragma once

#include <toml++/toml.h>

#include <set>
#include <string>
#include <vector>

namespace heel::sim {

struct Range {
  double low;
  double high;
  const char* unit;
};

class TomlSection {
 public:
  TomlSection(const toml::table& table, std::string name, std::string file);

  double number(const char* key, double fallback, const Range& range);
  std::int64_t integer(const char* key, std::int64_t fallback, std::int64_t low, std::int64_t high);
  std::string text(const char* key, const std::string& fallback);
  bool flag(const char* key, bool fallback);
  std::vector<double> numbers(const char* key, std::size_t count);  ///< empty when absent
  std::vector<std::string> texts(const char* key);                  ///< empty when absent
  bool has(const char* key) const { return table_.contains(key); }
  /// A required number.
  double need(const char* key, const Range& range);

  TomlSection section(const char* key);
  std::vector<TomlSection> sections(const char* key);

  /// Throws at the first key that was never asked for.
  void finish() const;
  /// Throws a complaint placed at `key`, or at the table where it is absent.
  [[noreturn]] void refuse(const char* key, const std::string& found_and_expected) const;

 private:
  const toml::node* find(const char* key);
  double checked(const char* key, const toml::node& node, const Range& range) const;

  const toml::table& table_;
  std::string name_;
  std::string file_;
  std::set<std::string> known_;
};

}  // namespace heel::sim
