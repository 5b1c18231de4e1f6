// Inner products of byte descriptors, several refs with all curs at a time, and searches in rows of them.
//
// Convention: a row holds the products of one ref with all curs, padded to whole blocks. Units: 1 /
// kProductUnit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vision/matching/byte_descriptors.h"

namespace heel {

/// Number of refs multiplied at a time.
inline constexpr std::size_t kByteTile = 4;

/// The product in padding places; less than any other.
inline constexpr std::int16_t kAbsentProduct = -32767;

/// products[t · padded + j] = (|a|² + |b|² − |a' − b'|²) / 2, where a is ref `first` + t, b is cur j, and a',
/// b' are their rounded values, for kByteTile refs (the last one is repeated if there are fewer) and every
/// member of every block. With a and b instead of a' and b' this is the inner product a·b, and |a' − b'|
/// differs from |a − b| by at most the errors of both.
void byte_products(const RefBytes& refs, std::size_t first, const CurBytes& curs, std::int16_t* products);

/// The two largest products.
struct TwoLargest {
  std::int16_t first = kAbsentProduct;
  std::int16_t second = kAbsentProduct;
};

/// The two largest of one row; its size is a whole number of blocks.
TwoLargest two_largest(std::span<const std::int16_t> row);

/// The two largest for each cur, over the refs: updates `first` and `second` of `size` curs with `rows` rows
/// as written by byte_products.
void keep_two_largest(const std::int16_t* products, std::size_t rows, std::size_t size, std::int16_t* first,
                      std::int16_t* second);

/// Writes the index of every product of `row` above `limit`, in order, and returns how many. `out` has room
/// for row.size().
std::size_t places_above(std::span<const std::int16_t> row, std::int16_t limit, std::int32_t* out);

}  // namespace heel
