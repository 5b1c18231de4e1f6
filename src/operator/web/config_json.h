// The configuration for the page's settings: every key of the table, with what may be done with it.
#pragma once

#include "config/config_table.h"
#include "operator/settings.h"
#include "operator/web/view_json.h"

namespace heel {

/// A number, a truth value, a text or a list of texts.
ViewJson config_value_json(const ConfigKey& key, const Config& config);

/// {"file":…,"keys":[{"key":…,"value":…,"file_value":…,"default":…,"min":…,…}]}
ViewJson config_json(const std::string& file, const SettingsView& settings);

}  // namespace heel
