#include "base/input_errors.hpp"

#include <utility>

namespace abut {

InputErrorList::InputErrorList(std::vector<InputError> all_errors)
    : InputError(all_errors.at(0)), all(std::move(all_errors)) {}

}  // namespace abut
