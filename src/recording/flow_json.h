// Flow structs as JSON and their JSON Schema, made from the table of their fields. Written and read again, a
// struct is the same to the bit, but for the kind of a NaN:
// - numbers have the shortest text that reads back the same; zero keeps its sign ("-0.0")
// - JSON has neither infinity nor NaN: such a field is left out, and the member "not_finite" of its object
//   gives its text: {"not_finite":{"person_m":"inf"}}. Viewers then draw nothing, and the schema holds.
// - enumerations are their texts (to_string)
// - bytes on the wire are hexadecimal
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "heel/flow.h"

namespace heel {

// For Flow = TickRecord, PoseEstimate, CaptureCounters, Event, WireBytes, FrameTiming.

template <typename Flow>
void append_flow_json(std::string& json, const Flow& record);

/// The other way. Fields that the text does not have keep their default, and those that the struct does not
/// have are ignored; `other_version` gets the names of both. Throws heel::Error naming the field whose value
/// is none that it can have.
template <typename Flow>
Flow flow_from_json(std::string_view json, std::set<std::string>& other_version);

/// `title`: "heel.Tick". All fields but numbers that may not be finite are required.
template <typename Flow>
std::string flow_json_schema(const std::string& title);

/// A JSON text in quotes. Bytes that are no UTF-8 become U+FFFD.
void append_json_text(std::string& json, std::string_view text);

}  // namespace heel
