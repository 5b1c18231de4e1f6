#include "commandline/config_man_page.h"

#include <fmt/format.h>

#include "commandline/roff.h"
#include "config/config_table.h"
#include "config/config_text.h"
#include "config/config_value.h"

namespace heel::commandline {
namespace {

/// "m/s, 0…1.5, default 0.75; reload: yes, set: smaller".
std::string facts(const ConfigKey& key, const Config& defaults) {
  std::string text;
  for (const std::string& fact : {std::string(key.unit), value_range(key)})
    if (!fact.empty()) text += fact + ", ";
  return fmt::format("{}default `{}`; reload: {}, set: {}", text, toml_value(key, defaults),
                     key.reload == Reload::Yes ? "yes" : "no", settable_values(key));
}

}  // namespace

std::string config_man_page() {
  const Config defaults;
  std::string text = roff_title("heel.toml", 5, "heel " HEEL_VERSION);
  text += ".SH NAME\nheel.toml \\- configuration of heeld\n.SH DESCRIPTION\n";
  text += roff_paragraph(
      "heeld reads one TOML file; the service reads /etc/heel/heel.toml. A key that is left out has its "
      "default "
      "value, and an unknown key is an error. Relative paths start at the folder of the file.");
  text += ".PP\n" +
          roff_paragraph(
              "`reload`: whether `systemctl reload heeld` takes over a new value. `set`: whether `heel "
              "set` may change it while heeld runs; of a limit, in which direction from the file's value.");
  text += ".PP\n" + roff_paragraph(
                        "`heeld --config FILE --check` reports every error, or prints every value and "
                        "where it comes from.");
  for (const ConfigSection& section : config_sections()) {
    text += fmt::format(".SH [{}]\n{}", section.name, roff_paragraph(section.about));
    for (const ConfigKey& key : config_keys())
      if (key.section == section.name)
        text += fmt::format(".TP\n.B {}\n{}.br\n{}", key.full_name(), roff_paragraph(key.effect),
                            roff_paragraph(facts(key, defaults)));
  }
  text += ".SH RULES BETWEEN KEYS\n";
  for (const ConfigRelation& relation : config_relations())
    text += fmt::format(".TP\n.B {}\n{}", relation.key, roff_paragraph(relation.requirement));
  return text + ".SH FILES\n.I /etc/heel/heel.toml\n.SH SEE ALSO\n.BR heeld (8),\n.BR heel (1)\n";
}

}  // namespace heel::commandline
