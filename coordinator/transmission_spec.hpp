#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <variant>

#include <fmt/format.h>

#include "base/fields.hpp"

namespace abut {

// What a scene says of the rules that couple the sides of an interface: names, keys and what they
// mean.

/// [MiB] of the port kernel of a surface, where the scene does not say.
constexpr double usual_kernel_memory = 512.0;

/// Default: the kinematic side solves a unilateral problem against the partner's moving surface.
struct UnilateralTransmission {
  static constexpr std::string_view name = "unilateral";
  std::string kinematic = "auto";       // body.port, or auto: by probe
  std::optional<double> kernel_memory;  // [MiB] of surfaces; absent: usual_kernel_memory
  void fields(Fields& f) {
    f.optional("kinematic", kinematic, "",
               "side that solves the one-body contact problem, as body.port; auto: the softer "
               "side");
    f.optional("kernel_memory", kernel_memory, "MiB",
               "largest memory of the port kernel by which a surface gives way; a contact that "
               "needs more takes more iterations; usual: 512",
               positive);
  }
};

/// The published form: motion overwritten on one side, internal force handed to the other.
struct DirichletNeumannTransmission {
  static constexpr std::string_view name = "dirichlet_neumann";
  std::string dirichlet;          // body.port
  bool swap_every_window = true;  // as published
  bool impact_projection = false;
  void fields(Fields& f) {
    f.required("dirichlet", dirichlet, "", "side on which motion is imposed first, as body.port");
    f.optional("swap_every_window", swap_every_window, "",
               "exchange of the roles in every window, as published");
    f.optional("impact_projection", impact_projection, "",
               "common velocity of both contact nodes at first touch, of the same momentum");
  }
};

/// Both sides belong to one body, which solves their contact itself: watched, never iterated.
struct InternalTransmission {
  static constexpr std::string_view name = "internal";
  void fields(Fields&) {}
};

/// Robin conditions on both sides: each sees its partner as a dashpot with the partner's force.
struct RobinTransmission {
  static constexpr std::string_view name = "robin";
  std::string impedance = "matched";  // matched | kernel | a number [kg/s]
  double number = 0.0;                // [kg/s], where a number is given
  void fields(Fields& f) {
    f.optional(
        "impedance", impedance, "kg/s",
        "impedance that each side sees: matched to the partner's by probe, kernel (step over "
        "the kernel's first coefficient), or a number; of tied surfaces a number, shared out by "
        "area: for comparisons, since unlike meshes lose energy over dashpots");
    if (f.purpose() != Fields::Purpose::read || impedance == "matched" || impedance == "kernel")
      return;
    const char* end = impedance.data() + impedance.size();
    const std::from_chars_result parsed = std::from_chars(impedance.data(), end, number);
    f.check(parsed.ec == std::errc() && parsed.ptr == end && number > 0.0 && std::isfinite(number),
            "impedance", fmt::format("is {}, which is no impedance", impedance),
            "Give matched, kernel, or a number above 0 in kg/s.");
  }
};

/// All there are. The first one holds where the scene does not choose.
using TransmissionSpec = std::variant<UnilateralTransmission, DirichletNeumannTransmission,
                                      InternalTransmission, RobinTransmission>;

/// Nothing is exchanged: both sides are of one body.
inline bool is_inside(const TransmissionSpec& how) {
  return std::holds_alternative<InternalTransmission>(how);
}
inline bool is_unilateral(const TransmissionSpec& how) {
  return std::holds_alternative<UnilateralTransmission>(how);
}
/// Accelerations are exchanged beside motions.
inline bool is_dashpot(const TransmissionSpec& how) {
  return std::holds_alternative<RobinTransmission>(how);
}

inline bool is_published(const TransmissionSpec& how) {
  return std::holds_alternative<DirichletNeumannTransmission>(how);
}

}  // namespace abut
