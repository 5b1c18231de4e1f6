// New values written into the text of a configuration file, of which comments, order and spaces stay as they
// are.
#pragma once

#include <span>
#include <string>

#include "config/config_set.h"

namespace heel {

/// `text` of the configuration file `file` with the values `ConfigChange::after`. The value of a key that the
/// text has is replaced where it stands; another key becomes a line below the last one of its section, or of
/// a new section at the end. Lines end as their neighbours do. Throws heel::Error with one line when the text
/// is no configuration, or when a key cannot be added because its section is written as an inline table or as
/// dotted keys.
std::string edited_config_text(const std::string& text, const std::string& file,
                               std::span<const ConfigChange> changes);

}  // namespace heel
