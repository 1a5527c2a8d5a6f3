#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "subdomain_solver/compare/pair_interior.hpp"
#include "subdomain_solver/fe/element_limit.hpp"
#include "subdomain_solver/make/makers.hpp"
#include "subdomain_solver/make/mass_range.hpp"
#include "subdomain_solver/make/scheme.hpp"

namespace abut {

namespace {

/// CFL 1 is meant: a step may pass the limit by round-off.
constexpr double pair_limit_slack = 1.0e-12;

using Refuse =
    std::function<void(const std::string& key, const std::string& what, const std::string& remedy)>;

/// Scheme and step of a pair; refuses what only single bars offer.
struct PairScheme {
  PairInterior::Parameters& parameters;
  const Refuse& refuse;

  void operator()(const CentralDifferenceSpec& s) const {
    parameters.step = s.step;
    parameters.words += ", central difference";
    if (s.dispersion_terms > 1 || s.bulk_viscosity > 0.0 || s.tchamwa > 1.0) {
      refuse("integrator.central_difference",
             "has dispersion terms, bulk viscosity or tchamwa, which bar_pair does not offer",
             "Leave them out: the conventional methods are measured on the plain scheme.");
    }
    const double limit = BarPair(parameters.bars[0], parameters.bars[1], ElementLengths::reference)
                             .stable_step(parameters.contact.penalty);
    if (s.step > limit * (1.0 + pair_limit_slack)) {
      refuse("integrator.central_difference.step",
             fmt::format("{:g} s is above the stable limit of {:g} s", s.step, limit),
             "Give a step of at most the limit, or an implicit integrator such as newmark.");
    }
  }
  void operator()(const NewmarkSpec& s) const {
    parameters.step = s.step;
    parameters.weights = StepWeights::newmark(s.beta, s.gamma);
    parameters.words += ", newmark";
  }
  void operator()(const BackwardEulerSpec& s) const {
    parameters.step = s.step;
    parameters.weights = StepWeights::backward_euler();
    parameters.words += ", backward Euler";
  }
  template <class Other>
  void operator()(const Other&) const {
    refuse("integrator", "is not offered to bar_pair",
           "Give central_difference, newmark or backward_euler.");
  }
};

void check_bars(const BarPairSpec& pair, const Refuse& refuse) {
  const double gap = pair.right.position - (pair.left.position + pair.left.length);
  if (gap < 0.0) {
    refuse("model.bar_pair.right.position", fmt::format("overlaps the left bar by {:g} m", -gap),
           "Move a bar until the gap is zero or more.");
  }
}

}  // namespace

std::array<BarProperties, 2> pair_properties(const BodySpec& spec) {
  const BarPairSpec& pair = std::get<BarPairSpec>(spec.model);
  const LinearElasticSpec& material = std::get<LinearElasticSpec>(*spec.material);
  std::array<BarProperties, 2> bars;
  for (std::size_t m : {0u, 1u}) {
    const PairedBarSpec& from = m == 0 ? pair.left : pair.right;
    BarProperties& bar = bars[m];
    bar.length = from.length;
    bar.area = from.area;
    bar.elements = from.elements;
    bar.position = from.position;
    bar.velocity = from.velocity;
    bar.youngs_modulus = *material.youngs_modulus;
    bar.density = material.density;
    bar.mass = mass_form(*spec.integrator);
  }
  return bars;
}

std::unique_ptr<Interior> make_pair(const BodySpec& spec, const Place& place) {
  const Refuse refuse = [&place](const std::string& key, const std::string& what,
                                 const std::string& remedy) {
    throw InputError(what, place.where(key), remedy);
  };
  const BarPairSpec& pair = std::get<BarPairSpec>(spec.model);
  check_bars(pair, refuse);
  require_room(pair.left.elements, bytes_of_bar_element,
               place.where("model.bar_pair.left.elements"));
  require_room(pair.right.elements, bytes_of_bar_element,
               place.where("model.bar_pair.right.elements"));
  PairInterior::Parameters parameters;
  parameters.bars = pair_properties(spec);
  for (const BarProperties& bar : parameters.bars) {
    const double node = bar.mass_total() / bar.elements;
    check_mass(node, node, spec, place);
  }
  if (const PenaltySpec* penalty = std::get_if<PenaltySpec>(&pair.contact))
    parameters.contact.penalty = penalty->stiffness;
  parameters.lengths = pair.current_lengths ? ElementLengths::current : ElementLengths::reference;
  parameters.words = fmt::format(
      "pair of bars, {} + {} elements, {}{}", pair.left.elements, pair.right.elements,
      parameters.contact.multiplier() ? "Lagrange multiplier"
                                      : fmt::format("penalty {:g} N/m", parameters.contact.penalty),
      pair.current_lengths ? ", current lengths" : "");
  std::visit(PairScheme{parameters, refuse}, *spec.integrator);
  parameters.words += fmt::format(", step {:g} s", parameters.step);
  return std::make_unique<PairInterior>(place.name(), parameters);
}

}  // namespace abut
