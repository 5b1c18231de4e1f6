// What `heel` says about itself beside its options: examples, exit statuses, files.
#pragma once

#include "commandline/program_text.h"

namespace heel::cli {

commandline::ProgramText heel_manual();

}  // namespace heel::cli
