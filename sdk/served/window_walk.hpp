#pragma once

#include <functional>
#include <span>
#include <vector>

#include "contract/subdomain.hpp"
#include "sdk/served/user_body.hpp"

namespace abut {

/// Takes a user's body through one window, and tells of it: traces, boxes, bounds, records.
class WindowWalk {
 public:
  /// `alive` is called after every substep.
  WindowWalk(UserBody& body, const Advance& asked, const std::function<void()>& alive);
  Outcome walk(Response& to);

 private:
  double time(int level) const;  // [s] level = 0..steps_
  void find_forces(int step);
  std::optional<Failed> substep(int step, Response& to);
  void sweep(Response& to, int record) const;
  void go(Response& to) const;
  void tell(Response& to, double time) const;
  std::span<const double> of_port(const std::vector<double>& values, std::size_t port) const;

  UserBody& body_;
  const Advance& asked_;
  const std::function<void()>& alive_;
  int steps_ = 0, each_ = 0;          // substeps of the window, and of a record
  double dt_ = 0.0;                   // [s]
  std::vector<double> force_, part_;  // [N] (values) in the substep
};

}  // namespace abut
