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

/// Gathers the errors of checks that do not depend on each other, so that one run tells of all. The
/// same error, as copies of a body have it, is told once.
class InputErrors {
 public:
  void add(const InputError& error);
  std::size_t count() const { return found_.size(); }

  /// Runs a check and keeps the errors that it throws.
  template <class Check>
  void gather(Check check) {
    try {
      check();
    } catch (const InputErrorList& errors) {
      for (const InputError& error : errors.all) add(error);
    } catch (const InputError& error) {
      add(error);
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
