// heel bundle: one file for a bug report.
#include "recording/bundle.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bundle_facts.h"
#include "commands.h"
#include "recording/recording_reader.h"

namespace heel::cli {
namespace {

struct BundleCommandOptions {
  std::string recording;
  std::string out = "heel-bundle.mcap";
  bool with_pictures = false;
  double max_mb = 20.0;
  bool json = false;
};

/// The service records in its state directory; without recordings its black box is in the runtime directory.
const std::vector<std::string> kServiceFolders{"/var/lib/heel", "/run/heel"};

void run_bundle(const BundleCommandOptions& options) {
  BundleOptions bundle{options.with_pictures, static_cast<std::uint64_t>(options.max_mb * 1e6),
                       machine_facts(), private_names()};
  const std::string recording =
      options.recording.empty() ? recording_in_first_of(kServiceFolders) : recording_in(options.recording);
  const BundleReport report = write_bundle(recording, options.out, bundle);
  for (const std::string& line : report.left_out) std::cerr << "heel bundle: " << line << '\n';
  if (options.json) {
    nlohmann::ordered_json json{{"file", options.out},
                                {"bytes", report.bytes},
                                {"recording", recording},
                                {"with_pictures", options.with_pictures},
                                {"texts", nlohmann::ordered_json::array()},
                                {"left_out", report.left_out}};
    for (const auto& [name, text] : bundle.texts) json["texts"].push_back(name);
    std::cout << json.dump(2) << '\n';
    return;
  }
  std::cout << fmt::format("{}: {:.1f} MB of {}, with", options.out, 1e-6 * static_cast<double>(report.bytes),
                           recording);
  for (const auto& [name, text] : bundle.texts) std::cout << ' ' << name;
  std::cout << (options.with_pictures ? "" : "; without pictures") << '\n';
}

}  // namespace

void add_bundle_command(CLI::App& app) {
  auto options = std::make_shared<BundleCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "bundle",
      "Packs a recording, the journal, versions and devices into one file for a bug report. Host name, user\n"
      "names, serial numbers of devices and pictures are left out. `heel replay` opens it");
  command
      ->add_option(
          "recording", options->recording,
          "a recording (*.mcap), or a folder of which the newest one is taken (default: /var/lib/heel,\n"
          "or /run/heel with the service's black box)")
      ->type_name("RECORDING");
  command->add_option("-o,--out", options->out, "the file")->type_name("FILE")->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object (default: text)");
  command->add_flag("--with-pictures", options->with_pictures, "pictures and templates as well");
  command->add_option("--max-mb", options->max_mb, "what the file may have at most, megabytes")
      ->check(number_from(0.1, 10000.0))
      ->capture_default_str();
  command->callback([options] { run_bundle(*options); });
}

}  // namespace heel::cli
