#include "sdk/served/keys.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "abut.h"
#include "base/counted.hpp"

namespace {

constexpr double not_read = std::numeric_limits<double>::quiet_NaN();

/// NaN where there is no number that fits.
double number_of_key(abut_keys& keys, const char* name, const char* unit, const abut::Rule& rule) {
  double value = not_read;
  keys.fields.required(name, value, unit, name, rule);
  keys.refused = keys.refused || std::isnan(value);
  return value;
}

}  // namespace

int abut_has(const abut_keys* keys, const char* name) {
  return keys->document.has(keys->path_of(name)) ? 1 : 0;
}

double abut_number(abut_keys* keys, const char* name, const char* unit) {
  return number_of_key(*keys, name, unit, abut::any);
}

double abut_positive(abut_keys* keys, const char* name, const char* unit) {
  return number_of_key(*keys, name, unit, abut::positive);
}

double abut_number_or(abut_keys* keys, const char* name, const char* unit, double otherwise) {
  return abut_has(keys, name) != 0 ? abut_number(keys, name, unit) : otherwise;
}

int abut_count(abut_keys* keys, const char* name) {
  int value = 0;
  keys->fields.required(name, value, "", name, abut::at_least(1.0));
  keys->refused = keys->refused || value == 0;
  return value == 0 ? 1 : value;
}

const char* abut_text(abut_keys* keys, const char* name, const char* otherwise) {
  std::string value = otherwise != nullptr ? otherwise : "";
  if (otherwise == nullptr) {
    keys->fields.required(name, value, "", name);
    keys->refused = keys->refused || abut_has(keys, name) == 0;
  } else {
    keys->fields.optional(name, value, "", name);
  }
  return keys->texts.emplace_back(std::move(value)).c_str();
}

int abut_length(const abut_keys* keys, const char* name) {
  int count = 0;
  while (keys->document.has(fmt::format("{}[{}]", keys->path_of(name), count))) ++count;
  return count;
}

void abut_numbers(abut_keys* keys, const char* name, const char* unit, double* to, int count) {
  std::vector<double> values;
  keys->fields.required(name, values, unit, name);
  const bool fits = values.size() == static_cast<std::size_t>(count);
  if (!fits && abut_has(keys, name) != 0)
    abut_refuse(keys, name, ("has " + abut::counted(values.size(), "number")).c_str(),
                fmt::format("Give {}.", count).c_str());
  keys->refused = keys->refused || !fits;
  for (int i = 0; i < count; ++i) to[i] = fits ? values[static_cast<std::size_t>(i)] : not_read;
}

void abut_refuse(abut_keys* keys, const char* name, const char* what, const char* remedy) {
  keys->refused = true;
  keys->fields.check(false, name, what, remedy);
}

int abut_refused(const abut_keys* keys) { return keys->refused ? 1 : 0; }
