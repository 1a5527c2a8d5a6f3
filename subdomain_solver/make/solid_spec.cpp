#include "subdomain_solver/make/solid_spec.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/counted.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "subdomain_solver/solve/petsc_solver.hpp"

namespace abut {

namespace {

void element_key(Fields& f, std::string& element, int dim) {
  f.word("element", element, generated_elements(dim), "element of the mesh");
}

void origin_key(Fields& f, bool& centred) {
  f.word("origin", centred, {"corner", "centre"}, "place of the part that is its origin");
}

void lattice_keys(Fields& f, std::size_t dim, std::vector<double>& lengths,
                  std::vector<double>& elements, std::vector<double>& grading) {
  f.required("lengths", lengths, "m", "edge lengths, one number per dimension", positive);
  f.required("elements", elements, "", "numbers of elements, one per dimension", at_least(1));
  f.optional("grading", grading, "",
             "lengths of the last element over the first, one number per dimension", positive);
  for (const auto& [key, list] :
       {std::pair("lengths", &lengths), {"elements", &elements}, {"grading", &grading}}) {
    f.check(list->size() == dim, key, "has " + counted(list->size(), "number"),
            fmt::format("Give {} numbers, one per dimension.", dim));
  }
  for (double count : elements) {
    f.check(count == std::floor(count), "elements", fmt::format("holds {:g}", count),
            "Give whole numbers.");
  }
  for (std::size_t d = 0; d < std::min(grading.size(), elements.size()); ++d) {
    f.check(elements[d] != 1.0 || grading[d] == 1.0, "grading",
            fmt::format("is {:g} along a direction with one element", grading[d]),
            "Give 1 there, or more elements.");
  }
}

void round_keys(Fields& f, double& radius, int& core, int& layers) {
  f.required(
      "radius", radius, "m",
      "radius of the nodes on the surface: between them cells are flat, and a coarse mesh has "
      "less volume than what is round",
      positive);
  f.required("core", core, "", "number of elements along an edge of the inner square or cube",
             at_least(1));
  f.required("layers", layers, "", "number of layers of elements around it", at_least(1));
}

/// Products and ratios of these and of what follows from them (squares of wave speeds) are numbers
/// then, whatever the mesh is.
constexpr double least = 1e-100, most = 1e100;

void check_range(Fields& f, std::string_view key, const std::optional<double>& value) {
  const double size = std::abs(value.value_or(0.0));
  f.check(
      size == 0.0 || (size >= least && size <= most), key,
      fmt::format("is {:g}, beyond the range from {:g} to {:g}", value.value_or(0.0), least, most),
      "Give all numbers in units in which they are of ordinary size.");
}

}  // namespace

void RectangleSpec::fields(Fields& f) {
  lattice_keys(f, 2, lengths, elements, grading);
  element_key(f, element, 2);
  origin_key(f, centred);
}

void DiskSpec::fields(Fields& f) {
  round_keys(f, radius, core, layers);
  element_key(f, element, 2);
}

void BoxSpec::fields(Fields& f) {
  lattice_keys(f, 3, lengths, elements, grading);
  element_key(f, element, 3);
  origin_key(f, centred);
}

void CylinderSpec::fields(Fields& f) {
  round_keys(f, radius, core, layers);
  f.required("length", length, "m", "length along the axis, which is z", positive);
  f.required("elements", elements, "", "number of elements along the axis", at_least(1));
  f.optional("grading", grading, "", "length of the last element over the first", positive);
  element_key(f, element, 3);
  origin_key(f, centred);
  f.idle(elements == 1, "grading", "one element has no other to be compared with");
}

void SphereSpec::fields(Fields& f) {
  round_keys(f, radius, core, layers);
  element_key(f, element, 3);
}

void MeshFileSpec::fields(Fields& f) {
  f.required("file", file, "",
             "mesh file, relative to the scene file: MSH 4.1 or 2.2, an .inp file, or Exodus II");
  f.optional("scale", scale, "m", "length of the file's unit", positive);
}

void AbaqusSpec::fields(Fields& f) {
  MeshFileSpec::fields(f);
  f.optional("part", part, "",
             "instance, part or set of elements of the file that is the body; empty: all of it");
}

void ElasticSpec::fields(Fields& f) {
  f.optional("youngs_modulus", youngs_modulus, "Pa", "Young's modulus", positive);
  f.optional("poissons_ratio", poissons_ratio, "", "Poisson's ratio", between(-1.0, 0.5));
  f.optional("bulk_modulus", bulk_modulus, "Pa", "bulk modulus", positive);
  f.optional("lame_modulus", lame_modulus, "Pa", "first Lame constant");
  f.optional("shear_modulus", shear_modulus, "Pa", "shear modulus", positive);
  f.required("density", density, "kg/m^3", "reference density", positive);
  check_range(f, "youngs_modulus", youngs_modulus);
  check_range(f, "bulk_modulus", bulk_modulus);
  check_range(f, "lame_modulus", lame_modulus);
  check_range(f, "shear_modulus", shear_modulus);
  check_range(f, "density", density);
}

void MooneyRivlinSpec::fields(Fields& f) {
  f.required("c10", c10, "Pa", "factor of the first invariant in the energy");
  f.required("c01", c01, "Pa", "factor of the second invariant in the energy");
  f.required("bulk_modulus", bulk_modulus, "Pa", "bulk modulus", positive);
  f.required("density", density, "kg/m^3", "reference density", positive);
  f.check(c10 + c01 > 0.0, "c10", fmt::format("and c01 have the sum {:g}", c10 + c01),
          "Give a positive sum: it is half the shear modulus.");
  check_range(f, "c10", c10);
  check_range(f, "c01", c01);
  check_range(f, "c10", c10 + c01);
  check_range(f, "bulk_modulus", bulk_modulus);
  check_range(f, "density", density);
}

void SaturationSpec::fields(Fields& f) {
  f.required("stress", stress, "Pa", "stress to which hardening tends", positive);
  f.required("rate", rate, "", "rate; hardening takes place over a plastic strain of 1/rate",
             positive);
  check_range(f, "stress", stress);
  check_range(f, "rate", rate);
}

void J2PlasticitySpec::fields(Fields& f) {
  ElasticSpec::fields(f);
  f.required("yield_stress", yield_stress, "Pa", "initial yield stress", positive);
  f.optional("hardening", hardening, "Pa", "slope of the yield stress over plastic strain",
             non_negative);
  f.optional_section("saturation", saturation, "part of the hardening that saturates");
  check_range(f, "yield_stress", yield_stress);
  check_range(f, "hardening", hardening);
  f.check(!saturation || saturation->stress >= yield_stress, "yield_stress",
          "is above saturation.stress", "Give a saturation stress of at least the yield stress.");
}

void PointSpec::fields(Fields& f) {
  f.required("at", at, "m", "place of a node at the start, undeformed, one number per dimension");
}

void ConstraintSpec::fields(Fields& f) {
  f.required("on", on, "", "side or node set of the mesh");
  f.optional("fixed", fixed, "", "hold in every direction");
  f.optional("x", x, "m", "displacement along x, an expression in x, y, z and t");
  f.optional("y", y, "m", "displacement along y, the same");
  f.optional("z", z, "m", "displacement along z, the same");
  f.optional("direction", direction, "",
             "direction along which value is prescribed (an inclined roller), one number per "
             "dimension");
  f.optional("value", value, "m", "displacement along direction, an expression");
  f.optional("symmetry", symmetry, "", "hold along the normal of the side, which must be plane");
  const int ways = (fixed ? 1 : 0) + (x.empty() && y.empty() && z.empty() ? 0 : 1) +
                   (direction.empty() ? 0 : 1) + (symmetry ? 1 : 0);
  f.check(ways == 1, "on", ways == 0 ? "prescribes nothing" : "is prescribed in more than one way",
          "Give one of: fixed: true; x, y, z; direction with value; symmetry: true.");
}

void LoadSpec::fields(Fields& f) {
  f.optional("on", on, "", "side of the mesh; absent for an acceleration");
  f.optional("traction", traction, "Pa",
             "force per reference area, one expression per dimension in x, y, z and t");
  f.optional("pressure", pressure, "Pa", "pressure towards the body, an expression");
  f.optional("follows", follows, "", "following of the present surface by the pressure");
  f.optional("acceleration", acceleration, "m/s^2", "force per mass, one expression per dimension");
  const int ways =
      (traction.empty() ? 0 : 1) + (pressure.empty() ? 0 : 1) + (acceleration.empty() ? 0 : 1);
  f.check(ways == 1, "on", ways == 0 ? "carries no load" : "carries more than one load",
          "Give one of traction, pressure and acceleration; let others be loads of their own.");
  f.check(!follows || !pressure.empty(), "follows", "belongs to a pressure",
          "Leave follows out, or give a pressure in place of the traction.");
  f.check(acceleration.empty() == !on.empty() || ways != 1, "on",
          on.empty() ? "is missing" : "does not belong to an acceleration",
          "Give the side of a traction or pressure; an acceleration acts on the whole body.");
}

void ConjugateGradientsSpec::fields(Fields& f) {
  f.optional("tolerance", tolerance, "", "residual relative to the right-hand side",
             between(1.0e-15, 1.0e-2));
}

void PetscSpec::fields(Fields& f) {
  f.optional("tolerance", tolerance, "", "residual relative to the right-hand side",
             between(1.0e-15, 1.0e-2));
}

void EquationsSpec::fields(Fields& f) {
  f.optional("tolerance", tolerance, "",
             "residual of Newton's method, relative to the largest force in the balance",
             between(1.0e-14, 1.0e-1));
  f.optional("max_iterations", max_iterations, "", "number of iterations after which a step fails",
             between(1, 1000));
  f.choice("linear", linear, "solver of linear equations", Presence::optional);
  f.check(has_petsc() || !std::holds_alternative<PetscSpec>(linear), "linear",
          "is petsc, which this build is without",
          "Build it again with PETSc: make build WITH=petsc; or leave linear out.");
}

}  // namespace abut
