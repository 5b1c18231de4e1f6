// Inner products of descriptors in bytes, several refs with all curs at once, and what is asked of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vision/matching/byte_descriptors.h"

namespace heel {

/// Refs multiplied at a time.
inline constexpr std::size_t kByteTile = 4;

/// Stands where there is no cur; less than any product.
inline constexpr std::int16_t kAbsentProduct = -32767;

/// products[t · padded + j]: (|a|² + |b|² − |a' − b'|²) / 2 in units of 1 / kProductUnit, with a = ref first
/// + t and b = cur j, for the kByteTile refs from `first` on (the last one again where there are fewer) and
/// every member of every block. An inner product a·b is the same of a and b themselves, and |a' − b'| differs
/// from |a − b| by no more than the errors of both.
void byte_products(const RefBytes& refs, std::size_t first, const CurBytes& curs, std::int16_t* products);

/// The larger two of everything compared so far.
struct TwoLargest {
  std::int16_t first = kAbsentProduct;
  std::int16_t second = kAbsentProduct;
};

/// Of one row of products; the size is a whole number of blocks.
TwoLargest two_largest(std::span<const std::int16_t> row);

/// The same for every cur, over the refs: takes `rows` rows of products, as byte_products gave them, into
/// what is known of `size` curs.
void keep_two_largest(const std::int16_t* products, std::size_t rows, std::size_t size, std::int16_t* first,
                      std::int16_t* second);

/// Writes the places of all products above `limit` in `row`, in order, and returns how many. `out` has room
/// for row.size().
std::size_t places_above(std::span<const std::int16_t> row, std::int16_t limit, std::int32_t* out);

}  // namespace heel
