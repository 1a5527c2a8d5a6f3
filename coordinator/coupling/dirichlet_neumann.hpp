#pragma once

#include "coordinator/coupling/exchange.hpp"

namespace abut {

/// The published form: motion (u, v, a) overwritten on the kinematic side, its internal force
/// handed to the other side. Iterated is the Neumann side's u, v and a  [M.14].
class DirichletNeumann final : public Exchange {
 public:
  /// `roles_swap`: what is the Neumann side now was the Dirichlet side of the window before.
  explicit DirichletNeumann(bool roles_swap) : roles_swap_(roles_swap) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override { return 3 * grid_.count; }
  void predict(Eigen::Ref<Eigen::VectorXd> x) const override;
  void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
              Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  void scales(Eigen::Ref<Eigen::VectorXd> s) const override;
  EnergyAccount energy_account() const override { return EnergyAccount::unknown; }
  bool ordered() const override { return true; }
  void state(Archive& archive) override;

 private:
  bool roles_swap_;
  Substeps grid_;  // of each of u, v and a
  double u_begin_ = 0.0, v_begin_ = 0.0, a_begin_ = 0.0;
  double f_begin_ = 0.0;  // [N] on the Neumann side, as exchanged at the end of the last window
  ReferenceScales scale_;
};

}  // namespace abut
