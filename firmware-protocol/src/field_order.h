// Two visitors with one interface, so that the field order of a packet is written once, for reading and
// writing:
//   template <class Visitor, class P> void visit_fields(Visitor& v, P& packet) { v.field(packet.a); … }
// `field` is required, `tail` may be missing at the end.
#pragma once

#include <cstdint>
#include <optional>

#include "arcos/packet.h"

namespace arcos::detail {

class FieldReader {
 public:
  explicit FieldReader(PacketReader& reader) : reader_(reader) {}
  void field(std::uint8_t& value) { value = reader_.u8(); }
  void field(std::uint16_t& value) { value = reader_.u16(); }
  void field(std::int16_t& value) { value = reader_.i16(); }
  void field(std::int32_t& value) { value = reader_.i32(); }
  void field(Text& value) { value = reader_.text(); }

  template <typename T>
  void tail(std::optional<T>& value) {
    // A partial field ends the tail, because the fields after it would be read from the wrong place.
    ended_ = ended_ || reader_.left() < sizeof(T);
    value.reset();
    if (!ended_) field(value.emplace());
  }
  void tail(std::optional<Text>& value) {
    ended_ = ended_ || !reader_.holds_text();
    value.reset();
    if (!ended_) field(value.emplace());
  }

 private:
  PacketReader& reader_;
  bool ended_ = false;
};

class FieldWriter {
 public:
  explicit FieldWriter(PacketWriter& writer) : writer_(writer) {}
  void field(std::uint8_t value) { writer_.u8(value); }
  void field(std::uint16_t value) { writer_.u16(value); }
  void field(std::int16_t value) { writer_.i16(value); }
  void field(std::int32_t value) { writer_.i32(value); }
  void field(const Text& value) { writer_.text(value); }

  template <typename T>
  void tail(const std::optional<T>& value) {
    ended_ = ended_ || !value;
    if (!ended_) field(*value);
  }

 private:
  PacketWriter& writer_;
  bool ended_ = false;
};

}  // namespace arcos::detail
