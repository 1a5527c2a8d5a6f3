#pragma once

#include <string_view>

namespace abut {

/// A file of coordinator/init/templates, as text in the program.
struct Template {
  std::string_view name, text;
};

/// Empty: there is none of this name.
std::string_view template_text(std::string_view name);

}  // namespace abut
