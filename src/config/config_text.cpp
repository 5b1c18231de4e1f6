#include "config/config_text.h"

#include <fmt/format.h>

#include <string_view>

#include "config/config_table.h"
#include "config/config_value.h"

namespace heel {
namespace {

constexpr std::string_view kExampleIntroduction =
    R"(# Configuration of heeld: every key with its default value. Written by `heeld --print-default-config`.
# Keys may be left out. Relative paths start at the folder of this file.
# "reloads": heeld applies a new value on SIGHUP (systemctl reload heeld). "restart": it must be restarted.
)";

constexpr std::string_view kManualIntroduction = R"(# Configuration

`heeld` reads one TOML file; the service reads `/etc/heel/heel.toml`. `config/heel.toml` holds every key with its default value.

- `heeld --config FILE --check` reports every error in a file, or prints every value and where it comes from.
- A key that is left out has its default value. An unknown key is an error.
- Relative paths start at the folder of the file.
- *Reload* says whether a new value is applied on SIGHUP (`systemctl reload heeld`). Where it says no, the new value needs a
  restart.
- *Set* says whether `heel set` may change the value of the running daemon. *smaller* and *larger* are limits: they can be made
  tighter than the file has them, in that direction, and brought back to the file's value, never made looser than it. Some limits are
  not set at all, because neither direction is always the safer one. See [operator.md](operator.md).
- A reload is all or nothing: `heeld` refuses a file that has an error or changes a key without reload, and keeps the old
  values.

This page is generated: change `src/config/config_table.cpp`, then run `heeld --print-config-manual > docs/configuration.md`.
)";

}  // namespace

std::string default_config_text() {
  const Config defaults;
  std::string text(kExampleIntroduction);
  for (const auto& section : config_sections()) {
    text += fmt::format("\n# {}\n[{}]\n", section.about, section.name);
    for (const auto& key : config_keys()) {
      if (key.section != section.name) continue;
      text +=
          fmt::format("# {}\n# {}; {}\n{} = {}\n", key.effect, expected_value(key),
                      key.reload == Reload::Yes ? "reloads" : "restart", key.name, toml_value(key, defaults));
    }
  }
  return text;
}

std::string config_toml(const Config& config) {
  std::string text;
  for (const auto& section : config_sections()) {
    text += fmt::format("[{}]\n", section.name);
    for (const auto& key : config_keys()) {
      if (key.section == section.name) text += fmt::format("{} = {}\n", key.name, toml_value(key, config));
    }
  }
  return text;
}

std::string config_manual_text() {
  const Config defaults;
  std::string text(kManualIntroduction);
  for (const auto& section : config_sections()) {
    text += fmt::format("\n## [{}]\n{}\n\n", section.name, section.about);
    text += "| key | unit | range | default | reload | set | effect |\n|---|---|---|---|---|---|---|\n";
    for (const auto& key : config_keys()) {
      if (key.section != section.name) continue;
      text += fmt::format("| `{}` | {} | {} | `{}` | {} | {} | {} |\n", key.full_name(), key.unit,
                          value_range(key), toml_value(key, defaults),
                          key.reload == Reload::Yes ? "yes" : "no", settable_values(key), key.effect);
    }
  }
  text += "\n## Rules between keys\n\n";
  for (const auto& relation : config_relations()) {
    text += fmt::format("- `{}` {}.\n", relation.key, relation.requirement);
  }
  return text;
}

std::string config_listing(const LoadedConfig& loaded) {
  std::string text;
  for (std::size_t i = 0; i < config_keys().size(); ++i) {
    const ConfigKey& key = config_keys()[i];
    const int line = loaded.line_of[i];
    text += fmt::format("{:<36}{:<28} # {}\n", key.full_name(), toml_value(key, loaded.config),
                        line == 0 ? "default" : fmt::format("{}:{}", loaded.file, line));
  }
  return text;
}

}  // namespace heel
