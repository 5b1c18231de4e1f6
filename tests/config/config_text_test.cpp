// The committed example file and manual are those that the table of keys makes. To write them again:
//   heeld --print-default-config > config/heel.toml;  heeld --print-config-manual > docs/configuration.md
#include "config/config_text.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "config/config_table.h"
#include "config/config_value.h"

namespace heel {
namespace {

std::string content_of(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(ConfigText, ExampleFileIsUpToDate) {
  EXPECT_EQ(content_of(HEEL_SOURCE_DIR "/config/heel.toml"), default_config_text());
}

TEST(ConfigText, ManualIsUpToDate) {
  EXPECT_EQ(content_of(HEEL_SOURCE_DIR "/docs/configuration.md"), config_manual_text());
}

TEST(ConfigText, ExampleFileSetsEveryKeyToItsDefault) {
  const LoadedConfig loaded = parse_config(default_config_text(), "heel.toml");
  const LoadedConfig empty = parse_config("", "heel.toml");
  for (std::size_t i = 0; i < config_keys().size(); ++i) {
    const ConfigKey& key = config_keys()[i];
    EXPECT_NE(loaded.line_of[i], 0) << key.full_name();
    EXPECT_EQ(toml_value(key, loaded.config), toml_value(key, empty.config)) << key.full_name();
  }
}

}  // namespace
}  // namespace heel
