// heel card: the sheet that is printed and held against the back, for `heel teach --card`.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "card_sheet.h"
#include "commands.h"
#include "files/atomic_file.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

struct CardOptions {
  std::string output;
  std::string paper = "a4";
  bool json = false;
};

void write_card(const CardOptions& options) {
  const Paper paper = options.paper == "a4" ? Paper::A4 : Paper::Letter;
  const bool pdf = options.output.ends_with(".pdf");
  if (!pdf && !options.output.ends_with(".svg"))
    throw Error(fmt::format("--output: '{}' (expected a name that ends in .pdf or .svg)", options.output));
  write_file_atomically(options.output, pdf ? card_as_pdf(paper) : card_as_svg(paper));
  if (options.json) {
    const nlohmann::ordered_json json{{"output", options.output},
                                      {"columns", kCardColumns},
                                      {"rows", kCardRows},
                                      {"square_m", kCardSquare_m},
                                      {"line_m", kCardLine_m}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print(
      "wrote {}: print it at 100 %, not fitted to the page. Its line must be {:g} mm long; if it is not, "
      "measure\na square and say it to heel teach by --card-square.\n",
      options.output, kCardLine_m * 1000.0);
}

}  // namespace

void add_card_command(CLI::App& app) {
  auto options = std::make_shared<CardOptions>();
  CLI::App* command = app.add_subcommand(
      "card",
      "Writes a sheet to print: a chessboard of known size that is held against the back, by which\n"
      "`heel teach --card` measures the distance.");
  command->add_option("-o,--output", options->output, "file to write, by its ending PDF or SVG")
      ->required()
      ->type_name("CARD.pdf");
  command->add_option("--paper", options->paper, "size of the sheet")
      ->capture_default_str()
      ->type_name("PAPER")
      ->check(CLI::IsMember({"a4", "letter"}));
  command->add_flag("--json", options->json, "one JSON object (default: text)");
  command->callback([options] { write_card(*options); });
}

}  // namespace heel::cli
