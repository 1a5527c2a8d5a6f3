#include "base/without_remedy.hpp"

#include <new>

#include "base/error.hpp"

namespace abut {

std::string without_remedy(const std::exception& error) {
  const auto placed = [](const auto& own) {
    return (own.where.empty() ? "" : own.where + ": ") + own.what_is_wrong;
  };
  if (const auto* input = dynamic_cast<const InputError*>(&error)) return placed(*input);
  if (const auto* run = dynamic_cast<const RunError*>(&error)) return placed(*run);
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "the memory is used up";
  return error.what();
}

}  // namespace abut
