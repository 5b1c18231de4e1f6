// Folders for output.
#pragma once

#include <string>

namespace heel {

/// Makes the folder and those above it where they are missing. Throws heel::Error naming it.
void make_folder(const std::string& folder);

}  // namespace heel
