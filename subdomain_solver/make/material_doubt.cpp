#include "subdomain_solver/make/material_doubt.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "subdomain_solver/make/solid_spec.hpp"

namespace abut {

namespace {

// Of all solids that bodies are made of, from foams and gels to osmium and diamond, and wide of it.
constexpr double least_density = 1.0, most_density = 3.0e4;         // [kg/m^3]
constexpr double least_stiffness = 100.0, most_stiffness = 2.0e12;  // [Pa]
constexpr double slowest = 0.2, fastest = 2.0e4;                    // [m/s] sqrt(E / rho)
/// In powers of ten: numbers this near, 6 %, are those of the same material.
constexpr double same_digits = 0.025;

/// Powers of ten of a set of units, against SI.
struct Powers {
  int stiffness = 0, density = 0;
  bool operator==(const Powers&) const = default;
};

constexpr Powers powers_of(int length, int mass, int time) {
  return {mass - length - 2 * time, mass - 3 * length};
}

/// Sets of length, mass and time in which engineers write scenes, a thousand apart in their units
/// of stiffness and density.
constexpr std::array<Powers, 10> in_use = {
    powers_of(0, 0, 0),     // m kg s
    powers_of(-3, 3, 0),    // mm t s
    powers_of(-3, 0, -3),   // mm kg ms
    powers_of(-3, -3, -3),  // mm g ms
    powers_of(-3, 0, 0),    // mm kg s
    powers_of(-3, -3, 0),   // mm g s
    powers_of(-3, -3, -6),  // mm g us
    powers_of(0, 3, 0),     // m t s
    powers_of(0, 3, -3),    // m t ms
    powers_of(-6, 0, 0),    // um kg s
};

double in_si(double value, const UnitSystem& units, const char* si_unit) {
  const std::optional<Unit> unit = parse_unit(units.word(si_unit));
  return unit ? value * unit->mantissa * std::pow(10.0, unit->exponent) : value;
}

/// "210 GPa" in SI.
double value_of(std::string_view text) {
  const std::optional<Quantity> quantity = split_quantity(text);
  const std::optional<Unit> unit = quantity ? parse_unit(quantity->unit) : std::nullopt;
  return unit ? converted(quantity->number, *unit, Unit{unit->dimension}).value_or(0.0) : 0.0;
}

DensityAndStiffness numbers_of(const Preset& preset) {
  DensityAndStiffness numbers;
  for (const auto& [key, text] : preset.values) {
    if (key == "density") numbers.density = value_of(text);
    if (key == "youngs_modulus") numbers.youngs_modulus = value_of(text);
  }
  return numbers;
}

/// Power of ten by which a number differs from another one of the same digits; none: other digits.
/// Units of stiffness and density that get mixed are powers of a thousand apart.
std::optional<int> power_between(double value, double of) {
  const double power = std::log10(value / of), thousands = 3.0 * std::round(power / 3.0);
  if (!(std::abs(power - thousands) < same_digits)) return std::nullopt;
  return static_cast<int>(thousands);
}

bool is_no_solid(const DensityAndStiffness& si) {
  const double speed = std::sqrt(si.youngs_modulus / si.density);
  const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
  return !within(si.density, least_density, most_density) ||
         !within(si.youngs_modulus, least_stiffness, most_stiffness) ||
         !within(speed, slowest, fastest);
}

/// A preset with these digits, and the powers of ten beside them.
struct Alike {
  std::string_view name;
  DensityAndStiffness numbers;
  Powers powers;
};

/// The one whose powers go together before all others.
std::optional<Alike> nearest(const DensityAndStiffness& numbers, bool known) {
  std::optional<Alike> found;
  for (const Preset& preset : ElasticSpec::presets()) {
    const DensityAndStiffness of = numbers_of(preset);
    const std::optional<int> density = power_between(numbers.density, of.density);
    const std::optional<int> stiffness = power_between(numbers.youngs_modulus, of.youngs_modulus);
    if (!density || !stiffness) continue;
    const Powers powers{-*stiffness, -*density};
    const bool together =
        known ? powers == Powers{} : std::ranges::find(in_use, powers) != in_use.end();
    if (together) return std::nullopt;
    if (!found) found = Alike{preset.name, of, powers};
  }
  return found;
}

}  // namespace

std::optional<MaterialDoubt> material_doubt(const DensityAndStiffness& given,
                                            const UnitSystem& units, bool known) {
  DensityAndStiffness numbers = given;
  std::string words =
      fmt::format("density {:g} and Young's modulus {:.4g}", given.density, given.youngs_modulus);
  if (known) {
    numbers = {in_si(given.density, units, "kg/m^3"), in_si(given.youngs_modulus, units, "Pa")};
    words = fmt::format("density {:.4g} kg/m^3 and Young's modulus {:.4g} Pa", numbers.density,
                        numbers.youngs_modulus);
  }
  if (const std::optional<Alike> alike = nearest(numbers, known)) {
    return MaterialDoubt{
        fmt::format("{} have the digits of {}, with powers of ten that do not go together", words,
                    alike->name),
        fmt::format("It has {:g} kg/m^3 and {:g} GPa. Give numbers with these units, material: {}, "
                    "or say what the scene's numbers are in, as units: mm t s.",
                    alike->numbers.density, 1.0e-9 * alike->numbers.youngs_modulus, alike->name)};
  }
  if (known && is_no_solid(numbers))
    return MaterialDoubt{fmt::format("{} are those of no solid", words),
                         "Look at the units of both, and at what the scene says under units."};
  return std::nullopt;
}

}  // namespace abut
