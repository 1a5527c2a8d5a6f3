#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace abut {

/// The numbers a configuration key may hold; every number must be finite as well.
struct Rule {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false;   // low itself is excluded
  bool below_high = false;  // high itself is excluded

  bool holds(double value) const;
  /// For messages, to follow "must be": "positive", "at least 1", "between 0 and 1".
  std::string words() const;
  /// For remedies: "greater than 0", "at least 1"; empty when all numbers fit.
  std::string range() const;
};

inline constexpr Rule any{};
inline constexpr Rule positive{.low = 0.0, .above_low = true};
inline constexpr Rule non_negative{.low = 0.0};
constexpr Rule at_least(double low) { return Rule{.low = low}; }
constexpr Rule at_most(double high) { return Rule{.high = high}; }
/// Both ends included.
constexpr Rule between(double low, double high) { return Rule{.low = low, .high = high}; }

enum class Presence { required, optional };

/// What every key states about itself. Unit "" means a pure number or text; `help` is a noun phrase
/// that can follow "the", or begins with what or whether.
struct Key {
  std::string_view name, unit, help;
  Presence presence = Presence::required;
};

/// A name that stands for a map of keys, as that of a material: `{choice: {key: value, ...}}`.
/// Values are texts as in a scene, with their units.
struct Preset {
  std::string_view name, choice;
  std::vector<std::pair<std::string_view, std::string_view>> values;
  std::string_view source;
};

/// Where one value lives.
using Slot = std::variant<double*, int*, std::int64_t*, bool*, std::string*, std::optional<double>*,
                          std::optional<int>*, std::vector<double>*, std::vector<std::string>*,
                          std::array<std::string, 2>*>;

class Fields;

/// A plain struct that lists its configuration keys.
template <class S>
concept HasFields = requires(S& value, Fields& f) {
  value.fields(f);
};

/// Step of a key path into a list: "[3]".
std::string index_step(std::size_t index);

/// Single-character insertions, deletions and replacements that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate a user may have meant; empty when none is near.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

/// The key for which a plain value stands in the place of a map of S: where S has `static constexpr
/// std::string_view shorthand`, `{name: value}` is short for `{name: {shorthand: value}}`. Empty:
/// none.
template <class S>
constexpr std::string_view shorthand_of() {
  if constexpr (requires { S::shorthand; }) return S::shorthand;
  return {};
}

/// Names that stand for the keys of S: where S has a static function `presets`, `{name: preset}`,
/// or the preset alone where the choice is the preset's own. Empty: none.
template <class S>
std::span<const Preset> presets_of() {
  if constexpr (requires { S::presets(); }) return S::presets();
  return {};
}

/// Of several: those of the first that has any.
template <class... S>
std::span<const Preset> presets_of_any() {
  std::span<const Preset> presets;
  ((presets.empty() ? void(presets = presets_of<S>()) : void()), ...);
  return presets;
}

}  // namespace abut
