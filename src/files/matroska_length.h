// What a Matroska or WebM file says of its own length. Source: RFC 8794 (EBML), RFC 9559 (Matroska).
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace heel {

/// Where the file's Segment ends, in bytes from its beginning; 0 when the file does not say, as of a live
/// stream, or is no Matroska file.
std::uint64_t matroska_segment_end(std::istream& file);

enum class StatedLength : std::uint8_t { Unknown, Complete, Short };
/// Compares that with the length of the file. What follows the Segment does not matter.
StatedLength matroska_length(const std::string& path);

}  // namespace heel
