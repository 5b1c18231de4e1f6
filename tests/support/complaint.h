// The error message of a call that must be refused.
#pragma once

#include <string>

#include "heel/error.h"

namespace heel::test {

/// The text of the heel::Error that `call` throws; "accepted" when it throws none.
template <typename Call>
std::string complaint_of(Call&& call) {
  try {
    call();
  } catch (const heel::Error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace heel::test
