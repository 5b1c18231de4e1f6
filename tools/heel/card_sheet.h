// The printed card by which heel teach measures how far the back is: a chessboard of known size, for A4 and
// Letter.
#pragma once

#include <string>

namespace heel::cli {

inline constexpr int kCardColumns = 5;  ///< squares
inline constexpr int kCardRows = 7;
inline constexpr double kCardSquare_m = 0.034;
/// A line on the card, by which a print at another scale is noticed.
inline constexpr double kCardLine_m = 0.15;

enum class Paper { A4, Letter };

/// The sheet as a file whose lengths are true when it is printed at its actual size.
std::string card_as_pdf(Paper paper);
std::string card_as_svg(Paper paper);

}  // namespace heel::cli
