#pragma once

#include <string>
#include <vector>

#include "contract/subdomain.hpp"

namespace abut {

/// What tables and measures show as one body: a body, or a member of one.
struct RecordedBody {
  int body = 0;      // index among the run's bodies
  int member = -1;   // index into Description::members; -1: the body itself
  std::string name;
  double mass = 0.0;  // [kg]
  int dim = 1;

  const Energy& energy(const BodyRecord& record) const;
  const std::vector<double>& momentum(const BodyRecord& record) const;
};

/// A body with members is represented by them.
std::vector<RecordedBody> recorded_bodies(const std::vector<const Description*>& bodies);

/// Index of the one on which a port lies; of the body's first where a port lies on no member.
int recorded_body_of(const std::vector<const Description*>& bodies, int body, int port);

}  // namespace abut
