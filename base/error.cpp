#include "base/error.hpp"

#include <utility>

namespace abut {
namespace {

std::string paragraph(const std::string& what_is_wrong, const std::string& where,
                      const std::string& remedy) {
  std::string text = where.empty() ? what_is_wrong : where + ": " + what_is_wrong;
  text += '.';
  if (!remedy.empty()) text += ' ' + remedy;
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
