#include "base/error.hpp"

#include <cctype>
#include <utility>

namespace abut {
namespace {

std::string paragraph(const std::string& what_is_wrong, const std::string& where,
                      const std::string& remedy) {
  std::string text = where.empty() ? what_is_wrong : where + ": " + what_is_wrong;
  text += '.';
  if (remedy.empty()) return text;
  text += ' ';
  text += static_cast<char>(std::toupper(static_cast<unsigned char>(remedy[0])));
  text += remedy.substr(1);
  const char last = text.back();
  if (last != '.' && last != '?' && last != '!') text += '.';
  return text;
}

}  // namespace

InputError::InputError(std::string what_is_wrong_, std::string where_, std::string remedy_)
    : std::runtime_error(paragraph(what_is_wrong_, where_, remedy_)),
      what_is_wrong(std::move(what_is_wrong_)),
      where(std::move(where_)),
      remedy(std::move(remedy_)) {}

RunError::RunError(std::string what_is_wrong_, std::string where_, std::string remedy_)
    : std::runtime_error(paragraph(what_is_wrong_, where_, remedy_)),
      what_is_wrong(std::move(what_is_wrong_)),
      where(std::move(where_)),
      remedy(std::move(remedy_)) {}

}  // namespace abut
