#include "toml/toml_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "heel/error.h"
#include "toml/toml_file.h"

namespace heel {
namespace {

const toml::table& empty_table() {
  static const toml::table table;
  return table;
}

}  // namespace

TomlSection::TomlSection(const toml::table& table, std::string name, std::string file)
    : table_(table), name_(std::move(name)), file_(std::move(file)) {}

void TomlSection::fail(const char* key, const std::string& found_and_expected) const {
  const toml::node* node = table_.get(key);
  const toml::source_position at = (node ? node->source() : table_.source()).begin;
  throw Error(toml_message(file_, at, full_name(key), found_and_expected));
}

void TomlSection::fail_value(const char* key, const toml::node& found, const std::string& expected) const {
  throw Error(toml_message(file_, found.source().begin, full_name(key),
                           fmt::format("{} (expected {})", toml_value_text(found), expected)));
}

const toml::node* TomlSection::find(const char* key) {
  read_keys_.insert(key);
  return table_.get(key);
}

double TomlSection::checked_number(const char* key, const toml::node& node, const NumberRange& range) const {
  const auto value = node.value<double>();
  if (!node.is_number() || !value || !(*value >= range.low && *value <= range.high)) {
    const std::string unit = *range.unit == '\0' ? "" : fmt::format(" {}", range.unit);
    fail_value(key, node, fmt::format("a number {:g}…{:g}{}", range.low, range.high, unit));
  }
  return *value;
}

double TomlSection::number(const char* key, double fallback, const NumberRange& range) {
  const toml::node* node = find(key);
  return node ? checked_number(key, *node, range) : fallback;
}

double TomlSection::required_number(const char* key, const NumberRange& range) {
  if (!find(key)) {
    const std::string unit = *range.unit == '\0' ? "" : fmt::format(" in {}", range.unit);
    fail(key, "missing (expected a number" + unit + ")");
  }
  return number(key, 0.0, range);
}

std::int64_t TomlSection::integer(const char* key, std::int64_t fallback, std::int64_t low,
                                  std::int64_t high) {
  const toml::node* node = find(key);
  if (!node) return fallback;
  const auto value = node->value_exact<std::int64_t>();
  if (!value || *value < low || *value > high)
    fail_value(key, *node, fmt::format("a whole number {}…{}", low, high));
  return *value;
}

std::string TomlSection::text(const char* key, const std::string& fallback) {
  const toml::node* node = find(key);
  if (!node) return fallback;
  const auto value = node->value_exact<std::string>();
  if (!value) fail_value(key, *node, "a text in quotes");
  return *value;
}

bool TomlSection::boolean(const char* key, bool fallback) {
  const toml::node* node = find(key);
  if (!node) return fallback;
  const auto value = node->value_exact<bool>();
  if (!value) fail_value(key, *node, "true or false");
  return *value;
}

std::vector<double> TomlSection::numbers(const char* key, std::size_t count) {
  const toml::node* node = find(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array || array->size() != count) {
    const std::string found =
        array ? fmt::format("a list of {}", array->size()) : std::string(toml_value_text(*node));
    fail(key, fmt::format("{} (expected a list of {} numbers)", found, count));
  }
  std::vector<double> values;
  for (const toml::node& item : *array) values.push_back(checked_number(key, item, {-1e9, 1e9, ""}));
  return values;
}

std::vector<std::vector<double>> TomlSection::rows(const char* key, std::size_t columns) {
  const toml::node* node = find(key);
  if (!node) return {};
  const std::string expected = fmt::format("a list of lists of {} numbers", columns);
  const toml::array* array = node->as_array();
  if (!array) fail_value(key, *node, expected);
  std::vector<std::vector<double>> rows;
  for (const toml::node& item : *array) {
    const toml::array* row = item.as_array();
    if (!row || row->size() != columns) fail_value(key, item, expected);
    std::vector<double>& values = rows.emplace_back();
    for (const toml::node& number : *row) values.push_back(checked_number(key, number, {-1e9, 1e9, ""}));
  }
  return rows;
}

std::vector<std::string> TomlSection::texts(const char* key) {
  constexpr const char* kExpected = "a list of texts in quotes";
  const toml::node* node = find(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array) fail_value(key, *node, kExpected);
  std::vector<std::string> values;
  for (const toml::node& item : *array) {
    const auto value = item.value_exact<std::string>();
    if (!value) fail_value(key, item, kExpected);
    values.push_back(*value);
  }
  return values;
}

TomlSection TomlSection::section(const char* key) {
  const toml::node* node = find(key);
  const std::string name = full_name(key);
  if (!node) return {empty_table(), name, file_};
  if (!node->as_table()) fail_value(key, *node, "a section [" + name + "]");
  return {*node->as_table(), name, file_};
}

std::vector<TomlSection> TomlSection::sections(const char* key) {
  std::vector<TomlSection> all;
  const toml::node* node = find(key);
  if (!node) return all;
  const std::string name = full_name(key);
  const std::string expected = "sections [[" + name + "]]";
  const toml::array* array = node->as_array();
  if (!array) fail_value(key, *node, expected);
  for (const toml::node& item : *array) {
    if (!item.as_table()) fail_value(key, item, expected);
    all.emplace_back(*item.as_table(), name, file_);
  }
  return all;
}

void TomlSection::reject_unknown_keys() const {
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (read_keys_.contains(name)) continue;
    const std::vector<std::string> known(read_keys_.begin(), read_keys_.end());
    throw Error(toml_message(file_, key.source().begin, full_name(name),
                             fmt::format("no such key{} (expected one of: {})",
                                         nearest_name_question(name, known), fmt::join(known, ", "))));
  }
}

}  // namespace heel
