#include "base/synonyms.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace abut {
namespace {

struct Synonyms {
  std::string_view ours;
  std::string_view others;  // in small letters, each between blanks
};

constexpr std::array<Synonyms, 49> table{{
    // material
    {"youngs_modulus", " e young youngs young_modulus elastic_modulus modulus emod e_modulus "},
    {"poissons_ratio", " nu poisson poissons poisson_ratio "},
    {"shear_modulus", " g mu shear "},
    {"bulk_modulus", " k kappa bulk compression_modulus "},
    {"lame_modulus", " lambda lame "},
    {"density", " rho mass_density "},
    {"yield_stress", " sigma_y sigma_yield yield yield_strength "},
    {"hardening", " h hardening_modulus "},
    {"linear_elastic", " elastic linear hooke hookean elasticity "},
    {"neo_hookean", " neohooke neo_hooke hyperelastic "},
    {"saint_venant_kirchhoff", " svk stvk st_venant_kirchhoff "},
    {"mooney_rivlin", " mooney "},
    {"hencky", " logarithmic "},
    {"j2_plasticity", " j2 plastic plasticity von_mises mises elastoplastic "},
    // integrator
    {"central_difference",
     " explicit central central_differences leapfrog verlet velocity_verlet "},
    {"newmark", " implicit trapezoidal trapezoid average_acceleration "},
    {"hht_alpha", " hht "},
    {"generalized_alpha", " generalised_alpha gen_alpha chung_hulbert "},
    {"quasi_static", " static statics quasistatic implicit_static "},
    {"rigid_motion", " rigid free_motion "},
    {"step", " dt time_step timestep h delta_t "},
    {"integrator", " time_integrator scheme time_scheme stepper "},
    {"spectral_radius", " rho_inf rho_infinity "},
    // body
    {"model", " type kind "},
    {"fe", " fem finite_element finite_elements "},
    {"modal", " modes reduced "},
    {"rigid_wall", " wall "},
    {"dimension", " dim ndim "},
    {"mesh", " geometry grid "},
    {"bar", " line rod truss beam "},
    {"box", " block brick cube cuboid "},
    {"rectangle", " plate quad square "},
    {"disk", " circle disc "},
    {"sphere", " ball "},
    {"length", " l "},
    {"lengths", " size sizes l "},
    {"area", " a cross_section "},
    {"elements", " n ne nel n_elements num_elements cells "},
    {"velocity", " v v0 speed "},
    {"position", " x x0 place origin "},
    {"initial", " initial_conditions ic start "},
    {"constraints", " bc bcs boundary_conditions boundary dirichlet clamps "},
    {"loads", " forces neumann "},
    {"traction", " force stress "},
    {"body_force", " gravity weight acceleration "},
    // scene
    {"end", " t_end tend stop duration final final_time "},
    {"begin", " t0 start t_begin initial_time "},
    {"window", " controller_step dt time_step coupling_step "},
    {"interfaces", " contacts couplings pairs "},
}};

}  // namespace

std::string meant_by(std::string_view word, std::span<const std::string> known) {
  std::string small(word);
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char letter) {
    return letter == '-' ? '_' : static_cast<char>(std::tolower(letter));
  });
  if (small.find(' ') != std::string::npos) return "";
  for (const Synonyms& row : table) {
    const bool listed = row.others.find(' ' + small + ' ') != std::string_view::npos;
    if (listed && std::find(known.begin(), known.end(), row.ours) != known.end())
      return std::string(row.ours);
  }
  return "";
}

}  // namespace abut
