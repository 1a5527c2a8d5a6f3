#include "coordinator/coupling/tie_net.hpp"

#include <algorithm>
#include <utility>

#include "coordinator/coupling/banded_tie_kernel.hpp"
#include "coordinator/coupling/kernel_bytes.hpp"
#include "coordinator/coupling/state_fields.hpp"
#include "coordinator/coupling/tie_contradiction.hpp"

namespace abut {

namespace {

/// Of residuals: [m/N] of forces, [N/m] of places of loose motions, which tell what is left over.
double unit_of(const TieLayout::Member& member) {
  return member.carried < 0 ? member.tie->unit() : 1.0 / member.tie->unit();
}

}  // namespace

void TieNet::begin(const KnownExchanges& known, std::span<const Eigen::Index> first,
                   Bodies& bodies) {
  layout_.members.clear();
  for (const auto& [joint, tie, part] : known.ties)
    layout_.add(*joint, *tie, {tie->grid(0).count, tie->grid(1).count}, first[part]);
  if (empty()) return;
  layout_.arrange(bodies);
  find_kernel(bodies);
  kernel_->turn(layout_);
  const Eigen::VectorXd own = kernel_->diagonal();
  for (const TieLayout::Member& member : layout_.members) {
    if (member.carried >= 0) continue;
    const double most = own.segment(member.inner, member.width).maxCoeff();
    member.tie->set_unit(most > 0.0 ? most : 1.0);
  }
}

/// Bodies are probed where their kernels are not known for as long as this window.
void TieNet::find_kernel(Bodies& bodies) {
  std::vector<int> pattern = layout_.pattern();
  const bool alike = pattern == pattern_, equal = alike && blocks_ == layout_.blocks;
  if (kernel_ != nullptr && alike && blocks_ >= layout_.blocks) return;
  pattern_ = std::move(pattern);
  blocks_ = layout_.blocks;
  kernel_.reset();  // its memory is wanted
  touching_.clear();
  const TieKernelPlan plan = plan_tie_kernel(layout_, options_, bodies);
  kernel_ = plan.banded ? make_banded_tie_kernel(layout_, plan.width, plan.lags, bodies)
                        : make_dense_tie_kernel(layout_, plan.lags, bodies);
  if (!restored_.empty() && equal) kernel_->take(layout_, restored_);
  restored_.clear();
}

bool TieNet::joins(int body) const {
  return std::ranges::find(layout_.parts, body, &TieLayout::Part::body) != layout_.parts.end();
}

const TiedPort* TieNet::touching(const Side& side, const std::vector<std::int32_t>& points,
                                 double most, Bodies& bodies) {
  const auto part = std::ranges::find(layout_.parts, side.body, &TieLayout::Part::body);
  if (empty() || !options_.used) return nullptr;
  if (part == layout_.parts.end() || part->stands) return nullptr;
  const bool alike =
      std::ranges::all_of(layout_.parts, [](const TieLayout::Part& p) { return p.steps == 1; }) &&
      std::ranges::all_of(layout_.members,
                          [](const TieLayout::Member& m) { return m.steps == 1 && m.carried < 0; });
  const PortGeometry& surface = bodies.port(side).geometry;
  const double values = points.empty() ? static_cast<double>(surface.points.size())
                                       : static_cast<double>(points.size()) * surface.dim;
  if (!alike || kernel_bytes(values, layout_.blocks) > most) return nullptr;
  auto known = std::ranges::find_if(
      touching_, [&side](const Touching& t) { return t.body == side.body && t.port == side.port; });
  if (known == touching_.end()) {
    touching_.push_back({side.body, side.port, nullptr});
    known = touching_.end() - 1;
  }
  const bool holds = known->answer != nullptr && known->answer->give().points == points &&
                     known->answer->give().count() >= layout_.blocks &&
                     known->answer->give().step == bodies.step(side.body);
  if (!holds)
    known->answer = std::make_unique<TiedPort>(layout_, *part, *kernel_, side.port, points, bodies);
  return known->answer.get();
}

bool TieNet::renew(Bodies& bodies) {
  return !empty() && options_.used && kernel_->renew(layout_, bodies);
}

void TieNet::predict(Eigen::VectorXd& x) const {
  if (empty() || !options_.used) return;
  Eigen::VectorXd jump(layout_.blocks * layout_.size);
  for (const TieLayout::Member& member : layout_.members) {
    if (member.carried >= 0 || member.tie->trial().size() == 0) return;
    layout_.spread(member, member.tie->trial(), jump);
  }
  const Eigen::VectorXd force = -kernel_->solve(jump);
  for (const TieLayout::Member& member : layout_.members)
    layout_.gather(member, force, x.segment(member.first, layout_.values_of(member)));
}

/// [m] of a residual in the ties' units, in blocks.
Eigen::VectorXd TieNet::jumps(const Eigen::VectorXd& r) const {
  Eigen::VectorXd jump(layout_.blocks * layout_.size);
  for (const TieLayout::Member& member : layout_.members)
    layout_.spread(member, unit_of(member) * r.segment(member.first, layout_.values_of(member)),
                   jump);
  return jump;
}

void TieNet::apply_inverse(Eigen::VectorXd& r) const {
  if (empty() || !options_.used) return;
  const Eigen::VectorXd force = kernel_->solve(jumps(r));
  for (const TieLayout::Member& member : layout_.members)
    layout_.gather(member, force, r.segment(member.first, layout_.values_of(member)));
}

std::string TieNet::contradiction(const Eigen::VectorXd& r, double tolerance, double time,
                                  const Bodies& bodies, bool& stays_open) const {
  stays_open = false;
  if (empty() || !options_.used) return {};
  const Eigen::VectorXd jump = jumps(r);
  const bool meet = std::ranges::all_of(layout_.members, [&](const TieLayout::Member& member) {
    if (member.carried >= 0) return true;
    Eigen::VectorXd own(layout_.values_of(member));
    layout_.gather(member, jump, own);
    return member.tie->seen_by_motion(own.lpNorm<Eigen::Infinity>()) <= tolerance;
  });
  if (meet) return {};
  const Eigen::VectorXd rest = kernel_->unanswered(jump);
  if (rest.size() == 0) return {};
  const Unanswered judged = judge_unanswered(layout_, jump, rest, tolerance, time, bodies);
  stays_open = judged.meshes;
  for (const TieLayout::Member& member : layout_.members) {
    if (!stays_open || member.carried >= 0) continue;
    Eigen::VectorXd own(layout_.values_of(member));
    layout_.gather(member, rest, own);
    member.tie->leave_open(-own);  // residuals are what jumps ask for
  }
  return judged.contradiction;
}

void TieNet::state(Archive& archive) {
  whole(archive, "blocks", blocks_);
  field(archive, "pattern", pattern_);
  if (archive.writing() && kernel_ != nullptr) restored_ = kernel_->answers();
  archive.field("answers", restored_);
  if (archive.writing()) restored_.clear();
}

}  // namespace abut
