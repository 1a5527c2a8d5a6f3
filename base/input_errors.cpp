#include "base/input_errors.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace abut {

InputErrorList::InputErrorList(std::vector<InputError> all_errors)
    : InputError(all_errors.at(0)), all(std::move(all_errors)) {}

void InputErrors::add(const InputError& error) {
  const std::string_view text = error.what();
  const auto same = [text](const InputError& other) { return text == other.what(); };
  if (std::none_of(found_.begin(), found_.end(), same)) found_.push_back(error);
}

}  // namespace abut
