#include "coordinator/coupling/schwarz.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "base/archive.hpp"

namespace abut {

namespace {

/// Islands of the past whose secants are kept. Many bodies hang together in ever new ways.
constexpr std::size_t most_kept = 256;
/// Of the mismatch, from sweep to sweep: where several joints wait for each other, secants that
/// lead to the answer may let it grow before.
constexpr double most_growth = 10.0;

/// Tells window lengths and layouts apart; single precision, because ends of equal windows are
/// rounded differently.
std::uint64_t layout_key(const TimeWindow& window, const std::vector<Eigen::Index>& first) {
  std::uint64_t key = std::bit_cast<std::uint32_t>(static_cast<float>(window.length()));
  for (Eigen::Index i : first) key = hash_combine(key, static_cast<std::uint64_t>(i));
  return key;
}

}  // namespace

Eigen::VectorXd Schwarz::inverse_of(const Eigen::VectorXd& r, std::span<const Joint> joints) const {
  Eigen::VectorXd out = r;
  for (std::size_t i = 0; i < layout_.joints.size(); ++i) {
    const Eigen::Index count = layout_.first[i + 1] - layout_.first[i];
    const Transmission& t = *joints[layout_.joints[i]].how;
    out.segment(layout_.first[i], count) = t.apply_inverse(r.segment(layout_.first[i], count));
  }
  ties_->apply_inverse(out);
  for (std::size_t i = 0; i < layout_.joints.size() && !ties_->empty(); ++i) {
    const Eigen::Index count = layout_.first[i + 1] - layout_.first[i];
    joints[layout_.joints[i]].how->follow(out, out.segment(layout_.first[i], count));
  }
  return out;
}

Eigen::VectorXd Schwarz::relaxed(Eigen::VectorXd r, std::span<const Joint> joints) const {
  for (std::size_t i = 0; i < layout_.joints.size(); ++i)
    r.segment(layout_.first[i], layout_.first[i + 1] - layout_.first[i]) *=
        joints[layout_.joints[i]].how->first_factor();
  return r;
}

Accelerator& Schwarz::accelerator_of(const Island& island) {
  Memory& memory = memories_[island.joints];
  if (memory.ties == nullptr) memory.ties = std::make_unique<TieNet>(options_.ties);
  ties_ = memory.ties.get();
  if (memory.accelerator != nullptr) return *memory.accelerator;
  memory.accelerator = make_([this](const Eigen::VectorXd& r) { return inverse_of(r, joints_); },
                             [this](const Eigen::VectorXd& r) { return relaxed(r, joints_); });
  return *memory.accelerator;
}

std::optional<Failed> Schwarz::sweep(const Island& island, std::span<const Joint> joints,
                                     const Layout& layout, const Eigen::VectorXd& x,
                                     Bodies& bodies) const {
  for (std::size_t level = 0; level < island.levels.size(); ++level) {
    for (const auto& [i, side] : island.ends[level]) {
      const Joint& joint = joints[layout.joints[i]];
      const Eigen::Index count = layout.first[i + 1] - layout.first[i];
      joint.how->impose(side, x.segment(layout.first[i], count), joint, bodies);
    }
    if (std::optional<Failed> failed = bodies.advance(island.levels[level])) return failed;
  }
  return std::nullopt;
}

/// Of Neumann sides whose motion without reactions is the first guess; afterwards they stand where
/// they stood. The last levels fly first: a body that finds contact as well flies against the
/// surfaces that it finds, where these were told to go.
std::optional<Failed> Schwarz::fly(const Island& island, std::span<const Joint> joints,
                                   Bodies& bodies) {
  for (std::size_t i = 0; i < layout_.joints.size(); ++i) {
    const Joint& joint = joints[layout_.joints[i]];
    if (!joint.how->flies()) joint.how->predict(part(x_, i));
  }
  for (auto ends = island.ends.rbegin(); ends != island.ends.rend(); ++ends) {
    const auto joint_at = [&](const Island::End& end) -> const Joint& {
      return joints[layout_.joints[end.joint]];
    };
    const auto flies = [&joint_at](const Island::End& end) {
      return joint_at(end).how->flies() && end.side != joint_at(end).kinematic;
    };
    std::vector<int> flown;
    for (const Island::End& end : *ends) {
      if (!flies(end)) continue;
      joint_at(end).how->release(joint_at(end), bodies);
      flown.push_back(joint_at(end).neumann_side().body);
    }
    if (flown.empty()) continue;
    std::ranges::sort(flown);
    flown.erase(std::unique(flown.begin(), flown.end()), flown.end());
    for (const Island::End& end : *ends) {
      const Joint& joint = joint_at(end);
      if (end.side == joint.kinematic &&
          std::ranges::binary_search(flown, joint.kinematic_side().body))
        joint.how->impose(end.side, part(x_, end.joint), joint, bodies);
    }
    if (std::optional<Failed> failed = bodies.advance(flown)) return failed;
    for (const Island::End& end : *ends) {
      if (!flies(end)) continue;
      joint_at(end).how->see_flight(joint_at(end), bodies);
      joint_at(end).how->predict(part(x_, end.joint));
    }
    for (int body : flown) bodies[body].restore();
  }
  return std::nullopt;
}

double Schwarz::see_images(std::span<const Joint> joints, const Bodies& bodies,
                           FieldResiduals& residual) {
  double mismatch = 0.0;
  residual = {};
  for (std::size_t i = 0; i < layout_.joints.size(); ++i) {
    const Joint& joint = joints[layout_.joints[i]];
    joint.how->image(part(x_, i), joint, bodies, part(g_, i));
    const FieldResiduals own = joint.how->measure(part(x_, i), part(g_, i));
    mismatch = std::max(mismatch, own.largest());
    residual.include(own, joint.how->stray());
    joint.how->scales(part(s_, i));
  }
  return mismatch;
}

/// Of the last images.
FieldResiduals Schwarz::residual_of(std::span<const Joint> joints) {
  FieldResiduals residual;
  for (std::size_t i = 0; i < layout_.joints.size(); ++i) {
    const Transmission& how = *joints[layout_.joints[i]].how;
    residual.include(how.measure(part(x_, i), part(g_, i)), how.stray());
  }
  return residual;
}

/// The iterate's last step, measured as its residual is.
double Schwarz::step_from(const Eigen::VectorXd& before, std::span<const Joint> joints) {
  double most = 0.0;
  for (std::size_t i = 0; i < layout_.joints.size(); ++i) {
    const Eigen::Index first = layout_.first[i], count = layout_.first[i + 1] - first;
    const Transmission& how = *joints[layout_.joints[i]].how;
    most = std::max(most,
                    how.measure(before.segment(first, count), x_.segment(first, count)).largest());
  }
  return most;
}

bool Schwarz::projected(std::span<const Joint> joints) const {
  return std::ranges::any_of(layout_.joints,
                             [&joints](int j) { return joints[j].how->projects(); });
}

/// The joints of an island begin a window.
void Schwarz::lay_out(const TimeWindow& window, const Island& island, std::span<const Joint> joints,
                      Bodies& bodies) {
  layout_.joints = island.joints;
  layout_.first.assign(1, 0);
  for (int j : island.joints) {
    const Joint& joint = joints[j];
    joint.how->share(std::ranges::binary_search(island.shared, joint.neumann_side().body));
    joint.how->begin(window, joint, bodies);
    layout_.first.push_back(layout_.first.back() + joint.how->values());
  }
  const Eigen::Index size = layout_.first.back();
  for (Eigen::VectorXd* v : {&x_, &g_, &s_}) v->resize(size);
  joints_ = joints;
}

/// What ties answer to contact is known exactly where each contact has a net of its own, of linear
/// bodies that step alike: then a plain step is Newton's. Else it is left to secants.
bool Schwarz::ease(const Island& island, std::span<const Joint> joints, Bodies& bodies) {
  bool known = contacts_apart(island, joints, bodies);
  for (std::size_t i = 0; known && i < island.joints.size(); ++i) {
    const Joint& joint = joints[island.joints[i]];
    known = joint.how->tie() != nullptr || joint.how->ease(*ties_, joint, bodies);
  }
  if (!known) withdraw(island, joints, bodies);
  return known;
}

void Schwarz::withdraw(const Island& island, std::span<const Joint> joints, Bodies& bodies) {
  for (const int j : island.joints) joints[j].how->withdraw(joints[j], bodies);
}

/// Plain steps contract: all joints are contact, or contact and ties. What a kernel of ties lets
/// give way, contact only holds.
bool Schwarz::contracts(const Island& island, std::span<const Joint> joints) const {
  const auto contact = [&joints](int j) { return joints[j].how->contracts(); };
  const auto small_steps = [&](int j) {
    return contact(j) || joints[j].how->tie() != nullptr;
  };
  return std::ranges::any_of(island.joints, contact) &&
         std::ranges::all_of(island.joints, small_steps);
}

std::variant<SchwarzReport, Failed> Schwarz::solve(const TimeWindow& window, const Island& island,
                                                   std::span<const Joint> joints, Bodies& bodies) {
  lay_out(window, island, joints, bodies);
  Accelerator& accelerator = accelerator_of(island);
  ties_->begin(island, joints, layout_.first, bodies);
  Course course;
  course.contracts = contracts(island, joints);
  course.tied = course.contracts && !ties_->empty();
  course.eased = course.tied && options_.kernels && ease(island, joints, bodies);
  if (std::optional<Failed> failed = fly(island, joints, bodies)) return *failed;
  ties_->predict(x_);
  accelerator.reset(layout_key(window, layout_.first));
  // Bodies that others hold answer a sweep with little of what they would if they were left alone.
  course.shared = course.contracts && !island.shared.empty();
  if (course.shared) accelerator.doubt();
  SchwarzReport report;
  for (report.iterations = 1;; ++report.iterations) {
    if (report.iterations > 1) {
      for (const std::vector<int>& level : island.levels) {
        for (int body : level) bodies[body].restore();
      }
    }
    if (std::optional<Failed> failed = sweep(island, joints, layout_, x_, bodies)) {
      const bool led = report.iterations > 1 && report.iterations < options_.max_iterations;
      if (!course.contracts || !led) return *failed;
      step_back(course, joints, accelerator);
      continue;
    }
    held_ = x_;
    const double before =
        std::exchange(course.mismatch, see_images(joints, bodies, report.residual));
    report.converged = report.residual.largest() <= options_.tolerance;
    bool stays_open = false;
    report.contradiction =
        ties_->contradiction(g_ - x_, options_.tolerance, window.end, bodies, stays_open);
    if (stays_open) {
      report.residual = residual_of(joints);
      report.converged = report.residual.largest() <= options_.tolerance;
    }
    if (!report.contradiction.empty()) {
      report.converged = false;
      return report;
    }
    if (report.iterations >= options_.max_iterations) return report;
    // later it is no bad luck
    course.early = 2 * report.iterations <= options_.max_iterations;
    const bool doubted = course.shared && course.early && report.residual.largest() > 0.0;
    if (report.converged && !doubted) return report;
    if (course.eased && !course.early) {
      course.eased = false;
      withdraw(island, joints, bodies);
    }
    const double most = course.shared ? most_growth : 1.0;
    course.grows = report.iterations > 1 && course.mismatch > most * before;
    step(course, joints, bodies, accelerator);
    // So a residual says little of how far the forces are from those that fit: the step does.
    if (report.converged && step_from(held_, joints) <= options_.tolerance) return report;
  }
}

/// Secants may lead to where a body has no answer; from the last iterate that had one, a part of
/// the plain step leads to another.
void Schwarz::step_back(Course& course, std::span<const Joint> joints, Accelerator& accelerator) {
  const ApplyInverse plain = [this, joints](const Eigen::VectorXd& r) {
    return inverse_of(r, joints);
  };
  accelerator.forget();
  course.share *= 0.5;
  if (!course.tied) course.careful = std::make_unique<Aitken>(plain, course.share);
  x_ = held_ + course.share * plain(g_ - held_);
}

/// The next iterate, of the last one and its image.
void Schwarz::step(Course& course, std::span<const Joint> joints, Bodies& bodies,
                   Accelerator& accelerator) {
  const bool newton = ties_->renew(bodies) || (options_.kernels && projected(joints));
  if (newton || course.eased) {
    x_ += inverse_of(g_ - x_, joints);
    return;
  }
  ties_->answer_alone(x_, g_);
  if (course.tied && course.best.left(x_, g_, course.mismatch)) {
    accelerator.forget();
    x_ = accelerator.next(course.best.iterate(), course.best.image());
    return;
  }
  if (course.contracts && !course.tied && course.early && course.grows) {
    accelerator.forget();
    const ApplyInverse plain = [this, joints](const Eigen::VectorXd& r) {
      return relaxed(r, joints);
    };
    if (course.growths++ > 0 && course.careful == nullptr)
      course.careful = std::make_unique<Aitken>(plain, 0.5);
  }
  Accelerator& next = course.careful != nullptr ? *course.careful : accelerator;
  next.weigh(s_);
  x_ = next.next(x_, g_);
}

void Schwarz::keep(std::span<const Island> islands) {
  if (memories_.size() <= most_kept + islands.size()) return;
  std::map<std::vector<int>, Memory> kept;
  for (const Island& island : islands) {
    auto node = memories_.extract(island.joints);
    if (!node.empty()) kept.insert(std::move(node));
  }
  memories_ = std::move(kept);
}

void Schwarz::accept(const Island& island) { memories_.at(island.joints).accelerator->accept(); }

}  // namespace abut
