#include "subdomain_solver/stabilisation_measures.hpp"

#include <array>

#include <fmt/format.h>

#include "base/index.hpp"

namespace abut {

std::vector<std::string> stabilisation_measure_names(int dim) {
  std::vector<std::string> names = {"stabilisation.share",       "stabilisation.share_max",
                                    "stabilisation.at_most",     "stabilisation.work",
                                    "stabilisation.share_along", "stabilisation.force"};
  for (int i = 0; i < dim; ++i) names.push_back(fmt::format("stabilisation.force.{}", "xyz"[i]));
  return names;
}

std::vector<double> stabilisation_measures(const FeModel& model, const QuasiStatic& statics,
                                           const Motion& motion) {
  const Stabilisation::Told told = Stabilisation::told(motion);
  Vector force;
  statics.stabilising_force(motion, force);
  model.to_space({force.data(), index(force.size())});
  const std::size_t dim = index(model.mesh().dim);
  std::array<double, 3> sum = {0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < index(force.size()); ++k)
    sum[k % dim] += force(static_cast<Eigen::Index>(k));
  std::vector<double> out = {told.share, told.share_most, statics.stabilisation()->at_most(),
                             told.work,  told.along,      told.force};
  out.insert(out.end(), sum.begin(), sum.begin() + static_cast<std::ptrdiff_t>(dim));
  return out;
}

}  // namespace abut
