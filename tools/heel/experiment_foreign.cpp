// The foreign set, that others' programs made: what is found in it, and where something is found that is not
// there.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "commandline/progress.h"
#include "evaluation/experiments/false_detections.h"
#include "evaluation/experiments/foreign_answers.h"
#include "evaluation/experiments/planar_matching.h"
#include "evaluation/reports/foreign_tables.h"
#include "experiment_options.h"

namespace heel::cli {
namespace {

std::vector<evaluation::ForeignRow> answers_of(const evaluation::ForeignSet& set,
                                               const evaluation::ForeignTemplates& templates,
                                               const evaluation::ForeignMethod& method) {
  commandline::Progress progress(std::string(method.name) + ", pictures",
                                 set.pictures.size() - templates.usable.size() - templates.refused.size());
  return evaluation::answer_foreign_set(set, templates, method,
                                        [&](std::size_t done) { progress.show(done); });
}

void run_false_detections(const ExperimentOptions& options, const evaluation::ForeignSet& set,
                          const evaluation::ForeignTemplates& templates, ExperimentResults& results) {
  const VisionConfig vision = vision_of(options);
  std::vector<evaluation::FalseDetections> all = {evaluation::search_other_prints(set, templates, vision)};
  const std::string video = data_folder(options) + kOtherPeople;
  if (std::filesystem::exists(video)) {
    all.push_back(evaluation::search_video(video, templates, vision));
  } else {
    results.skip(kFalse, "no " + video);
  }
  evaluation::write_false_detections(all, options.out + "/foreign_false.csv");
  for (const evaluation::FalseDetections& one : all) {
    std::string text = fmt::format("{:<10} {} in {}: {} pictures, found in {}\n", kFalse, one.searched_for,
                                   one.in, one.pictures, one.found.size());
    for (const std::string& found : one.found) text += fmt::format("{:<10}   {}\n", "", found);
    results.add(kFalse,
                {{"searched_for", one.searched_for},
                 {"in", one.in},
                 {"pictures", one.pictures},
                 {"found", one.found}},
                text);
  }
}

}  // namespace

void run_foreign_experiments(const ExperimentOptions& options, ExperimentResults& results) {
  const std::string folder =
      options.foreign_set.empty() ? data_folder(options) + "/foreign" : options.foreign_set;
  if (options.foreign_set.empty() && !std::filesystem::exists(folder)) {
    results.skip(kForeign, "no " + folder);
    return;
  }
  const evaluation::ForeignSet set = evaluation::read_foreign_set(folder);
  const evaluation::ForeignTemplates templates = evaluation::teach_foreign_set(set);
  if (options.wants(kForeign)) {
    const std::string file = options.out + "/foreign.csv";
    evaluation::write_foreign_rows(answers_of(set, templates, evaluation::heel_method(vision_of(options))),
                                   file);
    std::string text = evaluation::foreign_score_table(evaluation::read_foreign(file));
    ExperimentJson refused = ExperimentJson::array();
    for (const auto& [shirt, why] : templates.refused) {
      text += fmt::format("refused by teach: {} {} - {}\n", shirt.first, shirt.second, why);
      refused.push_back({{"shirt", {shirt.first, shirt.second}}, {"reason", why}});
    }
    results.add(kForeign, {{"file", file}, {"refused_by_teach", refused}}, text);
  }
  if (options.wants(kPlanar)) {
    std::vector<evaluation::ForeignRow> all;
    for (const evaluation::ForeignMethod& method : evaluation::planar_methods())
      for (evaluation::ForeignRow& row : answers_of(set, templates, method)) all.push_back(std::move(row));
    const std::string file = options.out + "/foreign_planar.csv";
    evaluation::write_foreign_rows(all, file);
    results.add(kPlanar,
                {{"file", file}, {"answers", all.size()}, {"methods", evaluation::planar_methods().size()}},
                fmt::format("{:<10} {} answers of {} methods: {}\n", kPlanar, all.size(),
                            evaluation::planar_methods().size(), file));
  }
  if (options.wants(kFalse)) run_false_detections(options, set, templates, results);
}

}  // namespace heel::cli
