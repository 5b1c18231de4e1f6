// Template files: the reference view of the shirt, its region, its distance and its camera, in one file.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "heel/shirt_template.h"

namespace heel {

/// The newest that is read; older ones are read, too. A template is written in the oldest that can hold it.
inline constexpr int kTemplateFormatVersion = 2;
inline constexpr int kMaxFurtherViews = 8;

/// Throws heel::Error naming the file and what is wrong: not a template, newer version, truncated, checksum.
ShirtTemplate read_template(const std::string& path);
/// target.shirt, with target.distance_m applied, then target.more_shirts.
std::vector<ShirtTemplate> read_templates(const TargetConfig& config);
/// The file of template `index` of read_templates().
const std::string& template_file(const TargetConfig& config, std::size_t index);
/// Writes to a temporary file and renames it: an existing template is never left half written.
void write_template(const ShirtTemplate& shirt, const std::string& path);

}  // namespace heel
