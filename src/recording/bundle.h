// One file for a bug report: a recording without private things, and facts about the machine as attachments.
// It is a recording itself: heel replay opens it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "recording/redaction.h"

namespace heel {

struct BundleOptions {
  bool with_pictures = false;  ///< and the templates, which are pictures, too
  std::uint64_t max_bytes = 20'000'000;
  std::map<std::string, std::string> texts;  ///< "journal.txt" and its content
  Redaction redaction;                       ///< of texts, configuration, log and operators
};

struct BundleReport {
  std::uint64_t bytes = 0;
  std::vector<std::string> left_out;  ///< what the size did not allow, and damage; one line each
};

/// Messages are copied as they are, but for the texts. What is too large is left out in this order: pictures,
/// bytes on the wire, poses (each tick has the newest one), the run's beginning. Throws heel::Error when the
/// recording cannot be read or the bundle not be written.
BundleReport write_bundle(const std::string& recording, const std::string& bundle,
                          const BundleOptions& options);

/// The newest recording in the first of these folders that has one. Throws heel::Error that says of each
/// folder why it gave none.
std::string recording_in_first_of(const std::vector<std::string>& folders);

}  // namespace heel
