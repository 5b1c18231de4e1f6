#include "config/config_text.h"

#include "config/config_table.h"

namespace heel {
namespace {

std::string reload_words(const ConfigKey& key) {
  return key.reload == Reload::Yes ? "reloads" : "restart";
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

}  // namespace

std::string default_config_text() {
  const Config defaults;
  std::string text =
      "# heeld's configuration: every key at its default. Written by `heeld --print-default-config`.\n"
      "# Keys may be left out. Relative paths start at this file's folder.\n"
      "# \"reloads\": taken over on SIGHUP (systemctl reload heeld); \"restart\": needs one.\n";
  for (const auto& section : config_sections()) {
    text += "\n# " + std::string(section.about) + "\n[" + std::string(section.name) + "]\n";
    for (const auto& key : config_keys()) {
      if (key.section != section.name) continue;
      text += "# " + std::string(key.effect) + "\n";
      text += "# " + expected_value(key) + "; " + reload_words(key) + "\n";
      text += std::string(key.name) + " = " + toml_value(key, defaults) + "\n";
    }
  }
  return text;
}

std::string config_manual_text() {
  const Config defaults;
  std::string text =
      "# Configuration keys\n\n"
      "Written by `heeld --print-config-manual` from the table in `src/config/config_table.cpp`; "
      "`heel.toml` beside it is the same as a file.\n"
      "`heeld --config FILE --check` says what is wrong with a file, or lists every value with its origin.\n"
      "A key that reloads is taken over on SIGHUP; a file that changes any other key, or has an error, is "
      "refused as a whole.\n";
  for (const auto& section : config_sections()) {
    text += "\n## [" + std::string(section.name) + "]\n" + std::string(section.about) + "\n\n";
    text += "| key | type | default | expected | reloads | effect |\n|---|---|---|---|---|---|\n";
    for (const auto& key : config_keys()) {
      if (key.section != section.name) continue;
      text += "| `" + key.full_name() + "` | " + std::string(type_name(key)) + " | `" +
              toml_value(key, defaults) + "` | " + expected_value(key) + " | " +
              (key.reload == Reload::Yes ? "yes" : "no") + " | " + std::string(key.effect) + " |\n";
    }
  }
  return text;
}

std::string config_listing(const LoadedConfig& loaded) {
  std::string text;
  for (std::size_t i = 0; i < config_keys().size(); ++i) {
    const ConfigKey& key = config_keys()[i];
    const int line = loaded.line_of[i];
    text += padded(key.full_name(), 36) + padded(toml_value(key, loaded.config), 28) + " # " +
            (line == 0 ? "default" : loaded.file + ":" + std::to_string(line)) + "\n";
  }
  return text;
}

}  // namespace heel
