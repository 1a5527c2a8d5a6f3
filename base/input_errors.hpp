#pragma once

#include <cstddef>
#include <vector>

#include "base/error.hpp"

namespace abut {

/// Several errors of one input. Read as an InputError it is the first of them.
class InputErrorList : public InputError {
 public:
  explicit InputErrorList(std::vector<InputError> all_errors);  // one or more

  std::vector<InputError> all;
};

/// Gathers the errors of checks that do not depend on each other, so that one run tells of all.
class InputErrors {
 public:
  void add(InputError error) { found_.push_back(std::move(error)); }
  std::size_t count() const { return found_.size(); }

  /// Runs a check and keeps the errors that it throws.
  template <class Check>
  void gather(Check check) {
    try {
      check();
    } catch (const InputErrorList& errors) {
      found_.insert(found_.end(), errors.all.begin(), errors.all.end());
    } catch (const InputError& error) {
      found_.push_back(error);
    }
  }

  /// Throws what was found, if anything.
  void raise() const {
    if (found_.size() == 1) throw InputError(found_.front());
    if (!found_.empty()) throw InputErrorList(found_);
  }

 private:
  std::vector<InputError> found_;
};

}  // namespace abut
