#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/index.hpp"
#include "base/key.hpp"

namespace abut {

/// Visitor over the configuration keys of a struct. Each struct lists its keys once, in
/// `void fields(Fields& f)`; the same list reads and validates, echoes the values in use and
/// documents the keys. Absent optional keys keep the member's value (base/yaml_fields.cpp).
class Fields {
 public:
  enum class Purpose { read, write, document };

  virtual ~Fields() = default;
  Purpose purpose() const { return purpose_; }

  /// One value; T is one of Slot's types. The rule holds for every number in a list.
  template <class T>
  void required(std::string_view key, T& value, std::string_view unit, std::string_view help,
                const Rule& rule = any) {
    leaf({key, unit, help, Presence::required}, Slot(&value), rule);
  }
  template <class T>
  void optional(std::string_view key, T& value, std::string_view unit, std::string_view help,
                const Rule& rule = any) {
    leaf({key, unit, help, Presence::optional}, Slot(&value), rule);
  }

  /// A word out of a list. T is a string, or a bool or enum whose value is the index into the list.
  template <class T, class Words = std::initializer_list<std::string_view>>
  void word(std::string_view key, T& value, const Words& words, std::string_view help,
            Presence presence = Presence::optional) {
    const std::span<const std::string_view> list(std::data(words), std::size(words));
    if constexpr (std::is_same_v<T, std::string>) {
      word_leaf({key, "", help, presence}, value, list);
    } else {
      std::string text(list[index(value)]);
      word_leaf({key, "", help, presence}, text, list);
      for (std::size_t i = 0; i < list.size(); ++i)
        if (list[i] == text) value = static_cast<T>(i);
    }
  }

  /// A map of the nested struct's keys that must be there.
  template <HasFields S>
  void section(std::string_view key, S& value, std::string_view help) {
    nested({key, "", help, Presence::required}, value);
  }
  /// When absent, the nested struct's defaults hold.
  template <HasFields S>
  void defaulted(std::string_view key, S& value, std::string_view help) {
    nested({key, "", help, Presence::optional}, value);
  }
  /// The same; when absent, the feature is absent.
  template <HasFields S>
  void optional_section(std::string_view key, std::optional<S>& value, std::string_view help) {
    std::optional<S> sample = value;
    if (purpose_ != Purpose::write) sample.emplace();
    if (!enter({key, "", help, Presence::optional}, sample.has_value())) return value.reset();
    sample->fields(*this);
    leave();
    if (purpose_ == Purpose::read) value = std::move(sample);
  }

  /// Absent means empty.
  template <HasFields S>
  void list(std::string_view key, std::vector<S>& values, std::string_view help) {
    const std::size_t count = enter_list({key, "", help, Presence::optional}, values.size());
    if (purpose_ == Purpose::read) values.assign(count, S{});
    if (purpose_ == Purpose::document) {
      S sample{};
      item("[]", sample);
    }
    for (std::size_t i = 0; i < values.size(); ++i) item(index_step(i), values[i]);
    leave();
  }

  /// A map from names that the user chooses to maps, in the file's order. A string member `name` of
  /// S is set.
  template <HasFields S>
  void map(std::string_view key, std::vector<std::pair<std::string, S>>& values,
           std::string_view help, Presence presence = Presence::required) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    enter_map({key, "", help, presence}, names);
    if (purpose_ == Purpose::read) {
      values.clear();
      for (const std::string& name : names) values.emplace_back(name, S{});
    }
    if (purpose_ == Purpose::document) {
      S sample{};
      item("<name>", sample);
    }
    for (auto& [name, value] : values) {
      if constexpr (requires(S one, std::string text) { one.name = text; }) value.name = name;
      item(name, value);
    }
    leave();
  }

  /// A one-key map `{name: {keys}}`, or the name alone when all its keys have defaults.
  /// Alternatives have `static constexpr std::string_view name` and `fields`.
  template <HasFields... A>
  void choice(std::string_view key, std::variant<A...>& value, std::string_view help,
              Presence presence = Presence::required) {
    choose<A...>({key, "", help, presence}, &value);
  }
  template <HasFields... A>
  void choice(std::string_view key, std::optional<std::variant<A...>>& value,
              std::string_view help) {
    std::optional<std::variant<A...>> sample = value;
    if (purpose_ == Purpose::read) sample.emplace();
    const bool present =
        choose<A...>({key, "", help, Presence::optional}, sample.has_value() ? &*sample : nullptr);
    if (purpose_ == Purpose::read) value = present ? std::move(sample) : std::nullopt;
  }

  /// A rule across keys of this map; `key` is the one to blame. `what` follows the key path,
  /// `remedy` is a sentence. Only a reader looks at it, and only when no key is missing.
  void check(bool ok, std::string_view key, const std::string& what, const std::string& remedy) {
    if (purpose_ == Purpose::read && !ok) broken(key, what, remedy);
  }
  /// Where `is_idle`, a key has no effect: a reader refuses it where it is given, a writer leaves
  /// it out. `why` follows "has no effect: ".
  virtual void idle(bool is_idle, std::string_view key, std::string_view why) = 0;
  /// This key belongs to another reader of the same map.
  virtual void ignore(std::string_view key) = 0;
  /// All keys not declared here belong to another reader of the same map.
  virtual void ignore_rest() = 0;

 protected:
  explicit Fields(Purpose purpose) : purpose_(purpose) {}

  virtual void leaf(const Key& key, Slot slot, const Rule& rule) = 0;
  virtual void word_leaf(const Key& key, std::string& value,
                         std::span<const std::string_view> words) = 0;
  /// Every enter that succeeds, and every descend, is closed by leave(). `present` matters to a
  /// writer.
  virtual bool enter(const Key& key, bool present) = 0;
  virtual std::size_t enter_list(const Key& key, std::size_t count) = 0;
  virtual void enter_map(const Key& key, std::vector<std::string>& names) = 0;
  /// Empty: absent. A reader returns the name found, the others the `current` one.
  virtual std::string enter_choice(const Key& key, std::span<const std::string_view> names,
                                   std::string_view current, std::span<const Preset> presets) = 0;
  virtual void descend(std::string_view name, std::string_view shorthand,
                       std::span<const Preset> presets) = 0;
  virtual void leave() = 0;
  virtual void broken(std::string_view key, const std::string& what, const std::string& remedy) = 0;

 private:
  template <class S>
  void nested(const Key& key, S& value) {
    if (!enter(key, true)) return;
    value.fields(*this);
    leave();
  }
  template <class S>
  void item(std::string_view name, S& value) {
    descend(name, shorthand_of<S>(), presets_of<S>());
    value.fields(*this);
    leave();
  }
  template <class S>
  void document(S sample) {
    item(S::name, sample);
  }
  template <class... A>
  bool choose(const Key& key, std::variant<A...>* value) {
    constexpr std::array<std::string_view, sizeof...(A)> names{A::name...};
    const std::string_view current = value != nullptr ? names[value->index()] : std::string_view();
    const std::string name = enter_choice(key, names, current, presets_of_any<A...>());
    if (purpose_ == Purpose::document) {
      (document(A{}), ...);
      leave();
      return true;
    }
    if (name.empty()) return false;
    if (purpose_ == Purpose::read)
      ((A::name == name ? void(value->template emplace<A>()) : void()), ...);
    std::visit([this, &name](auto& alternative) { item(name, alternative); }, *value);
    leave();
    return true;
  }

  Purpose purpose_;
};

}  // namespace abut
