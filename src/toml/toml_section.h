// Strict reading of one TOML section (table): every key has a type and a range, and a key that no code has
// read is an error. Messages read "FILE:LINE:COLUMN: SECTION.KEY: what was found (expected …)".
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace heel {

/// The values a number may have, ends included. NaN is in no range.
struct NumberRange {
  double low;
  double high;
  const char* unit;  ///< empty: none
};

/// Reads the keys of one table. All functions throw heel::Error with the place in the file.
class TomlSection {
 public:
  /// `table` must outlive it. `name` is the full name as messages show it, empty for the whole file.
  TomlSection(const toml::table& table, std::string name, std::string file);

  // The value of a key; `fallback` where the key is absent.
  double number(const char* key, double fallback, const NumberRange& range);
  std::int64_t integer(const char* key, std::int64_t fallback, std::int64_t low, std::int64_t high);
  std::string text(const char* key, const std::string& fallback);
  bool boolean(const char* key, bool fallback);
  /// Exactly `count` numbers; empty when the key is absent.
  std::vector<double> numbers(const char* key, std::size_t count);
  /// A list of lists of `columns` numbers each; empty when the key is absent.
  std::vector<std::vector<double>> rows(const char* key, std::size_t columns);
  /// Empty when the key is absent.
  std::vector<std::string> texts(const char* key);
  /// The value of a key that must be there.
  double required_number(const char* key, const NumberRange& range);

  bool has(const char* key) const { return table_.contains(key); }

  /// [NAME.KEY]; an empty section where it is absent.
  TomlSection section(const char* key);
  /// All [[NAME.KEY]], in order.
  std::vector<TomlSection> sections(const char* key);

  /// Throws at the first key that none of the functions above has read.
  void reject_unknown_keys() const;
  /// Throws an error about `key`, at its value, or at the section where the key is absent.
  [[noreturn]] void fail(const char* key, const std::string& found_and_expected) const;

 private:
  const toml::node* find(const char* key);
  std::string full_name(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }
  [[noreturn]] void fail_value(const char* key, const toml::node& found, const std::string& expected) const;
  double checked_number(const char* key, const toml::node& node, const NumberRange& range) const;

  const toml::table& table_;
  std::string name_;
  std::string file_;
  std::set<std::string> read_keys_;
};

}  // namespace heel
