// What a field of a flow struct is, for what is made from their table.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include "heel/flow.h"
#include "recording/flow_fields.h"

namespace heel::field {

template <typename T>
struct ArrayOf {
  using Element = void;
};
template <typename T, std::size_t N>
struct ArrayOf<std::array<T, N>> {
  using Element = T;
};
template <typename T>
using ElementOf = typename ArrayOf<std::remove_const_t<T>>::Element;

template <typename T>
struct IsCountedBytes : std::false_type {};
template <typename C, typename B>
struct IsCountedBytes<CountedBytes<C, B>> : std::true_type {};

template <typename T>
concept Flag = std::same_as<T, bool>;
template <typename T>
concept Whole = std::integral<T> && !Flag<T>;
template <typename T>
concept Named = std::is_enum_v<T>;
template <typename T>
concept Chars = std::same_as < ElementOf<T>,
char > ;
template <typename T>
concept Numbers = std::same_as < ElementOf<T>,
double > ;
template <typename T>
concept Structs = std::is_class_v<ElementOf<T>>;
template <typename T>
concept Struct = std::is_class_v<T> && std::is_void_v<ElementOf<T>> && !IsCountedBytes<T>::value;

/// The text of an enumeration's value, by its number; null: there is none.
template <Named E>
const char* text_of(int number) {
  const char* const text = to_string(static_cast<E>(number));
  return std::string_view(text) == "?" ? nullptr : text;
}

}  // namespace heel::field
