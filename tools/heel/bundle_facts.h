// What a bug report needs to know of the machine: versions, kernel, devices, the journal; and which names in
// it are private.
#pragma once

#include <map>
#include <string>

#include "recording/redaction.h"

namespace heel::cli {

/// "versions.txt", "devices.txt" and, where there is one, "journal.txt", not redacted yet.
std::map<std::string, std::string> machine_facts();

/// The host's name, and the names of those who log in to it.
Redaction private_names();

}  // namespace heel::cli
