#include "sim/scene/toml_section.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "heel/error.h"

namespace heel::sim {
namespace {

const toml::table& empty_table() {
  static const toml::table table;
  return table;
}

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace

TomlSection::TomlSection(const toml::table& table, std::string name, std::string file)
    : table_(table), name_(std::move(name)), file_(std::move(file)) {}

void TomlSection::refuse(const char* key, const std::string& found_and_expected) const {
  const toml::node* node = table_.get(key);
  const toml::source_position at = (node ? node->source() : table_.source()).begin;
  const std::string full = name_.empty() ? key : name_ + "." + key;
  throw Error(file_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + full + ": " +
              found_and_expected);
}

const toml::node* TomlSection::find(const char* key) {
  known_.insert(key);
  return table_.get(key);
}

double TomlSection::checked(const char* key, const toml::node& node, const Range& range) const {
  const auto value = node.value<double>();
  const std::string expected =
      "(expected a number, " + shown(range.low) + " to " + shown(range.high) + " " + range.unit + ")";
  if (!node.is_number() || !value) refuse(key, "not a number " + expected);
  if (!(*value >= range.low && *value <= range.high))
    refuse(key, shown(*value) + " is out of range " + expected);
  return *value;
}

double TomlSection::number(const char* key, double fallback, const Range& range) {
  const toml::node* node = find(key);
  return node ? checked(key, *node, range) : fallback;
}

double TomlSection::need(const char* key, const Range& range) {
  if (!find(key)) refuse(key, "missing (expected a number in " + std::string(range.unit) + ")");
  return number(key, 0.0, range);
}

std::int64_t TomlSection::integer(const char* key, std::int64_t fallback, std::int64_t low,
                                  std::int64_t high) {
  const toml::node* node = find(key);
  if (!node) return fallback;
  const auto value = node->value_exact<std::int64_t>();
  if (!value || *value < low || *value > high)
    refuse(key, "not a whole number in range (expected " + std::to_string(low) + " to " +
                    std::to_string(high) + ")");
  return *value;
}

std::string TomlSection::text(const char* key, const std::string& fallback) {
  const toml::node* node = find(key);
  if (!node) return fallback;
  const auto value = node->value_exact<std::string>();
  if (!value) refuse(key, "not a text (expected \"…\")");
  return *value;
}

bool TomlSection::flag(const char* key, bool fallback) {
  const toml::node* node = find(key);
  if (!node) return fallback;
  const auto value = node->value_exact<bool>();
  if (!value) refuse(key, "neither true nor false (expected one of them)");
  return *value;
}

std::vector<double> TomlSection::numbers(const char* key, std::size_t count) {
  const toml::node* node = find(key);
  if (!node) return {};
  const std::string expected = "(expected [" + std::to_string(count) + " numbers])";
  const toml::array* array = node->as_array();
  if (!array || array->size() != count) refuse(key, "not a list of that length " + expected);
  std::vector<double> values;
  for (const toml::node& item : *array) values.push_back(checked(key, item, {-1e9, 1e9, "each"}));
  return values;
}

std::vector<std::string> TomlSection::texts(const char* key) {
  const toml::node* node = find(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array) refuse(key, "not a list (expected [\"…\", …])");
  std::vector<std::string> values;
  for (const toml::node& item : *array) {
    const auto value = item.value_exact<std::string>();
    if (!value) refuse(key, "holds something that is not a text (expected [\"…\", …])");
    values.push_back(*value);
  }
  return values;
}

TomlSection TomlSection::section(const char* key) {
  const toml::node* node = find(key);
  const std::string full = name_.empty() ? key : name_ + "." + key;
  if (!node) return {empty_table(), full, file_};
  if (!node->as_table()) refuse(key, "not a section (expected [" + full + "])");
  return {*node->as_table(), full, file_};
}

std::vector<TomlSection> TomlSection::sections(const char* key) {
  std::vector<TomlSection> all;
  const toml::node* node = find(key);
  if (!node) return all;
  const std::string full = name_.empty() ? key : name_ + "." + key;
  const toml::array* array = node->as_array();
  if (!array) refuse(key, "not a list of sections (expected [[" + full + "]])");
  for (const toml::node& item : *array) {
    if (!item.as_table()) refuse(key, "holds something that is not a section (expected [[" + full + "]])");
    all.emplace_back(*item.as_table(), full, file_);
  }
  return all;
}

void TomlSection::finish() const {
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (known_.contains(name)) continue;
    std::string list;
    for (const std::string& known : known_) list += (list.empty() ? "" : ", ") + known;
    const toml::source_position at = key.source().begin;
    throw Error(file_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                (name_.empty() ? name : name_ + "." + name) + ": unknown key (expected one of " + list + ")");
  }
}

}  // namespace heel::sim
