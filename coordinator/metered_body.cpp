#include "coordinator/metered_body.hpp"

#include <chrono>

namespace abut {

void MeteredBody::start(const Advance& request) {
  meter_.start();
  body_.start(request);
}

Outcome MeteredBody::finish(Response& response) {
  response.compute_seconds = 0.0;  // of a body that fails it would be an earlier one's
  Outcome outcome = body_.finish(response);
  meter_.finish(number_, response.compute_seconds);
  return outcome;
}

PortKernel MeteredBody::probe(const Probing& asked) {
  const auto began = std::chrono::steady_clock::now();
  meter_.start();
  PortKernel kernel = body_.probe(asked);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
  meter_.finish(number_, wall.count());
  return kernel;
}

std::vector<std::unique_ptr<Subdomain>> metered(const std::vector<Subdomain*>& bodies,
                                                BodyMeter& meter) {
  std::vector<std::unique_ptr<Subdomain>> all;
  for (Subdomain* body : bodies)
    all.push_back(std::make_unique<MeteredBody>(*body, all.size(), meter));
  return all;
}

}  // namespace abut
