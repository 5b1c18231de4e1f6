// The committed example file and manual equal those made from the table of keys. To write them again:
//   heeld --print-default-config > config/heel.toml;  heeld --print-config-manual > docs/configuration.md
#include "config/config_text.h"

#include <gtest/gtest.h>

#include "config/config_table.h"
#include "config/config_value.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

using test::read_text;
using test::source_path;

TEST(ConfigText, ExampleFileIsUpToDate) {
  EXPECT_EQ(read_text(source_path("config/heel.toml")), default_config_text());
}

TEST(ConfigText, ManualIsUpToDate) {
  EXPECT_EQ(read_text(source_path("docs/configuration.md")), config_manual_text());
}

TEST(ConfigText, ExampleFileSetsEveryKeyToItsDefault) {
  const LoadedConfig loaded = parse_config(default_config_text(), "heel.toml");
  const LoadedConfig empty = parse_config("", "heel.toml");
  ASSERT_FALSE(config_keys().empty());
  for (std::size_t i = 0; i < config_keys().size(); ++i) {
    const ConfigKey& key = config_keys()[i];
    EXPECT_NE(loaded.line_of[i], 0) << key.full_name();
    EXPECT_EQ(toml_value(key, loaded.config), toml_value(key, empty.config)) << key.full_name();
  }
}

}  // namespace
}  // namespace heel
