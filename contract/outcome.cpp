#include "contract/outcome.hpp"

namespace abut {

const char* to_string(Failed::Cause cause) {
  switch (cause) {
    case Failed::Cause::no_convergence: return "no convergence";
    case Failed::Cause::inverted_element: return "inverted element";
    case Failed::Cause::step_too_small: return "step too small";
    case Failed::Cause::non_finite: return "non-finite state";
  }
  return "unknown";
}

}  // namespace abut
