// Folders for output.
#pragma once

#include <string>

namespace heel {

/// Makes the folder and those above it where they are missing. Throws heel::Error naming it, also
/// when it cannot be written: before the work whose results it is for.
void make_folder(const std::string& folder);

}  // namespace heel
