// How many members an aggregate has, at compile time: a table of its fields that leaves one out can be
// refused.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace heel {

namespace detail {

/// Becomes any member.
struct AnyMember {
  template <typename T>
  constexpr operator T() const;  // NOLINT: the conversion is its purpose
};

template <typename T, std::size_t... I>
constexpr bool takes_members(std::index_sequence<I...>) {
  return requires {
    T{(static_cast<void>(I), AnyMember{})...};
  };
}

}  // namespace detail

/// Of an aggregate without base classes.
template <typename T, std::size_t N = 0>
constexpr std::size_t member_count() {
  static_assert(std::is_aggregate_v<T>);
  if constexpr (detail::takes_members<T>(std::make_index_sequence<N + 1>{})) {
    return member_count<T, N + 1>();
  } else {
    return N;
  }
}

}  // namespace heel
