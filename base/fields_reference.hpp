#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.hpp"

namespace abut {

/// The keys of structs as Markdown tables, one section per heading: key path, type, unit, default
/// or "required", help. Generated from the declared fields, so it cannot disagree with the reader.
class Reference {
 public:
  struct Row {
    std::string path, type, unit, fallback, help;
  };

  /// The keys of a default-constructed S, which live at `path`, after what was added before.
  template <HasFields S>
  void add(std::string_view path) {
    S sample{};
    const std::unique_ptr<Fields> documenter = documenter_at(path);
    sample.fields(*documenter);
  }
  void heading(std::string_view text);
  std::string markdown() const;

 private:
  struct Section {
    std::string heading;
    std::vector<Row> rows;
  };
  std::unique_ptr<Fields> documenter_at(std::string_view path);
  std::vector<Section> sections_;
};

}  // namespace abut
