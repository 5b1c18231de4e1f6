#include "config/config_edit.h"

#include <toml++/toml.h>

#include "config/config_places.h"
#include "toml/toml_file.h"

namespace heel {
namespace {

class TextEdit {
 public:
  TextEdit(std::string& text, const std::string& file) : text_(text), file_(file) {}

  void apply(const ConfigChange& change) {
    const auto dot = change.key.find('.');
    const std::string section = change.key.substr(0, dot), name = change.key.substr(dot + 1);
    // Read again for each change: the one before has moved what comes after it.
    const toml::table root = parse_toml(text_, file_);
    const toml::table* table = root[section].as_table();
    if (table == nullptr) {
      append_section(text_, section, {name + " = " + change.after});
    } else if (const toml::node* value = table->get(name)) {
      replace(*value, change.after);
    } else {
      add_key(*table, change.key, name, change.after);
    }
  }

 private:
  void replace(const toml::node& value, const std::string& by) {
    const std::size_t begin = offset_of(text_, value.source().begin);
    text_.replace(begin, offset_of(text_, value.source().end) - begin, by);
  }

  void add_key(const toml::table& table, const std::string& full_name, const std::string& name,
               const std::string& value) {
    insert_lines(text_, place_of_new_key(text_, file_, table, full_name), {name + " = " + value});
  }

  std::string& text_;
  const std::string& file_;
};

}  // namespace

std::string edited_config_text(const std::string& text, const std::string& file,
                               std::span<const ConfigChange> changes) {
  std::string edited = text;
  TextEdit edit(edited, file);
  for (const ConfigChange& change : changes) edit.apply(change);

  check_edit(text, edited, file, changes);
  return edited;
}

}  // namespace heel
