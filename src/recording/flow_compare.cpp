#include "recording/flow_compare.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "recording/flow_fields.h"

namespace heel {
namespace {

/// One number, flag or name of a struct.
struct FlatField {
  std::uint64_t bits;  // what is compared
  double number;
  const char* text;  // of an enumeration; null: `number` is the value
};

/// All of a struct's values in order; their names only where they are asked for.
class Flattener {
 public:
  explicit Flattener(bool with_names) : with_names_(with_names) {}

  void operator()(const char* name, const auto& field) { add(name, field); }

  std::vector<FlatField> values;
  std::vector<std::string> names;

 private:
  template <typename Field>
  void add(const char* name, const Field& field) {
    if constexpr (std::same_as<Field, double>) {
      const double value = std::isnan(field) ? std::numeric_limits<double>::quiet_NaN() : field;
      push(name, {std::bit_cast<std::uint64_t>(value), value, nullptr});
    } else if constexpr (std::is_enum_v<Field>) {
      push(name,
           {static_cast<std::uint64_t>(field), std::numeric_limits<double>::quiet_NaN(), to_string(field)});
    } else if constexpr (std::integral<Field>) {
      push(name, {static_cast<std::uint64_t>(field), static_cast<double>(field), nullptr});
    } else if constexpr (requires { field.begin(); }) {
      int index = 0;
      for (const auto& element : field) {
        if (!with_names_) {
          add(name, element);
        } else {
          add(fmt::format("{}_{}", name, index++).c_str(), element);
        }
      }
    } else {
      const std::string outer = path_;
      if (with_names_) path_ += std::string(name) + '.';
      fields(*this, field);
      path_ = outer;
    }
  }
  void push(const char* name, FlatField field) {
    values.push_back(field);
    if (with_names_) names.push_back(path_ + name);
  }

  const bool with_names_;
  std::string path_;
};

template <typename Flow>
Flattener flattened(const Flow& record, bool with_names) {
  Flattener flat(with_names);
  fields(flat, record);
  return flat;
}

std::string shown(const FlatField& field) {
  return field.text != nullptr ? field.text : fmt::format("{}", field.number);
}

}  // namespace

template <typename Flow>
bool same_flow(const Flow& a, const Flow& b) {
  const Flattener flat_a = flattened(a, false), flat_b = flattened(b, false);
  for (std::size_t i = 0; i < flat_a.values.size(); ++i)
    if (flat_a.values[i].bits != flat_b.values[i].bits) return false;
  return true;
}

template <typename Flow>
std::vector<FieldDifference> flow_differences(const Flow& a, const Flow& b) {
  const Flattener flat_a = flattened(a, true), flat_b = flattened(b, true);
  std::vector<FieldDifference> all;
  for (std::size_t i = 0; i < flat_a.values.size(); ++i) {
    const FlatField &one = flat_a.values[i], &other = flat_b.values[i];
    if (one.bits == other.bits) continue;
    all.push_back({flat_a.names[i], shown(one), shown(other), std::abs(one.number - other.number)});
  }
  return all;
}

template bool same_flow(const TickRecord&, const TickRecord&);
template std::vector<FieldDifference> flow_differences(const TickRecord&, const TickRecord&);
template bool same_flow(const PoseEstimate&, const PoseEstimate&);
template std::vector<FieldDifference> flow_differences(const PoseEstimate&, const PoseEstimate&);

}  // namespace heel
