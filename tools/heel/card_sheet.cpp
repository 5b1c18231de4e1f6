#include "card_sheet.h"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

namespace heel::cli {
namespace {

constexpr double kMmPerM = 1000.0;
constexpr double kPointsPerMm = 72.0 / 25.4;
constexpr double kLine_mm = 0.4;  // as wide as the ruler's line is drawn
constexpr double kTick_mm = 4.0;
constexpr double kTextHeight_mm = 18.0;  // below the squares: the ruler and two lines
constexpr double kLetter_mm = 3.6;

/// Millimetres from the upper left corner of the sheet.
struct BlackRectangle {
  double x, y, width, height;
};
struct SheetText {
  double x, y;  ///< of the base line's left end
  std::string text;
};
struct Sheet {
  double width = 0.0, height = 0.0;
  std::vector<BlackRectangle> black;
  std::vector<SheetText> texts;
};

void add_ruler(Sheet& sheet, double x, double y) {
  const double length = kCardLine_m * kMmPerM;
  sheet.black.push_back({x, y - kLine_mm / 2, length, kLine_mm});
  for (const double end : {x, x + length - kLine_mm})
    sheet.black.push_back({end, y - kTick_mm / 2, kLine_mm, kTick_mm});
}

Sheet drawn_sheet(Paper paper) {
  Sheet sheet;
  sheet.width = paper == Paper::A4 ? 210.0 : 215.9;
  sheet.height = paper == Paper::A4 ? 297.0 : 279.4;
  const double square = kCardSquare_m * kMmPerM;
  const double left = (sheet.width - kCardColumns * square) / 2;
  const double top = (sheet.height - kCardRows * square - kTextHeight_mm) / 2;
  for (int row = 0; row < kCardRows; ++row)
    for (int column = row % 2; column < kCardColumns; column += 2)
      sheet.black.push_back({left + column * square, top + row * square, square, square});
  const double below = top + kCardRows * square;
  add_ruler(sheet, left, below + 5.0);
  sheet.texts = {
      {left, below + 11.5,
       fmt::format("This line must be {:g} mm long: print at 100 %, not fitted to the page.",
                   kCardLine_m * kMmPerM)},
      {left, below + 16.5,
       fmt::format("heel teach --card: flat against the back, every square in view. Squares of {:g} mm.",
                   square)}};
  return sheet;
}

/// The objects of a PDF file with the table of where each begins.
std::string pdf_file(const std::vector<std::string>& objects) {
  std::string pdf = "%PDF-1.4\n";
  std::string table;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    table += fmt::format("{:010} 00000 n \n", pdf.size());
    pdf += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
  }
  return pdf + fmt::format(
                   "xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R "
                   ">>\nstartxref\n{2}\n%%EOF\n",
                   objects.size() + 1, table, pdf.size());
}

}  // namespace

std::string card_as_pdf(Paper paper) {
  const Sheet sheet = drawn_sheet(paper);
  // A PDF's y grows upwards.
  const auto up = [&](double y_mm) { return (sheet.height - y_mm) * kPointsPerMm; };
  std::string drawing;
  for (const auto& [x, y, width, height] : sheet.black)
    drawing += fmt::format("{:.4f} {:.4f} {:.4f} {:.4f} re f\n", x * kPointsPerMm, up(y + height),
                           width * kPointsPerMm, height * kPointsPerMm);
  for (const auto& [x, y, text] : sheet.texts)
    drawing += fmt::format("BT /F {:.2f} Tf {:.4f} {:.4f} Td ({}) Tj ET\n", kLetter_mm * kPointsPerMm,
                           x * kPointsPerMm, up(y), text);
  // Viewers that fit every page to the paper are asked not to.
  return pdf_file(
      {"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
       "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
       fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R /Resources << "
                   "/Font << /F 5 0 R >> >> >>",
                   sheet.width * kPointsPerMm, sheet.height * kPointsPerMm),
       fmt::format("<< /Length {} >>\nstream\n{}endstream", drawing.size(), drawing),
       "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"});
}

std::string card_as_svg(Paper paper) {
  const Sheet sheet = drawn_sheet(paper);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}mm\" height=\"{1:g}mm\" viewBox=\"0 0 {0:g} "
      "{1:g}\">\n<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"white\"/>\n",
      sheet.width, sheet.height);
  for (const auto& [x, y, width, height] : sheet.black)
    svg += fmt::format("<rect x=\"{:.4f}\" y=\"{:.4f}\" width=\"{:.4f}\" height=\"{:.4f}\"/>\n", x, y, width,
                       height);
  for (const auto& [x, y, text] : sheet.texts)
    svg += fmt::format(
        "<text x=\"{:.4f}\" y=\"{:.4f}\" font-family=\"Helvetica, Arial, sans-serif\" "
        "font-size=\"{:g}\">{}</text>\n",
        x, y, kLetter_mm, text);
  return svg + "</svg>\n";
}

}  // namespace heel::cli
