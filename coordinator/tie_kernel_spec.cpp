#include "coordinator/tie_kernel_spec.hpp"

#include <charconv>
#include <system_error>

#include <fmt/format.h>

namespace abut {

void TieKernelSpec::fields(Fields& f) {
  f.optional("memory", memory, "MiB",
             "largest memory of the kernels by which bodies that ties hold together answer forces "
             "of any row at every other one; where they need more, rows answer their neighbours, "
             "and windows take a call or two more",
             positive);
  f.optional(
      "band", band, "",
      "which rows answer each other; auto: all of them where that fits, else those that waves "
      "reach in a window; waves: these, even where all fit; or a number: those at most so "
      "many spacings of the coarser side away");
  if (f.purpose() != Fields::Purpose::read || band == "auto" || band == "waves") return;
  constexpr double most = 1000.0;
  const char* end = band.data() + band.size();
  double number = 0.0;
  const std::from_chars_result parsed = std::from_chars(band.data(), end, number);
  const bool whole = parsed.ec == std::errc() && parsed.ptr == end;
  f.check(whole && number >= 1.0 && number <= most, "band",
          fmt::format("is {}, which is no number of spacings from 1 to {:g}", band, most),
          "Give auto, waves, or such a number.");
  rows = number;
}

}  // namespace abut
