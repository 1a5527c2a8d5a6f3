#include "coordinator/metered_body.hpp"

#include <chrono>
#include <type_traits>

namespace abut {

template <class Call>
auto MeteredBody::heard(Call&& call) {
  try {
    return call();
  } catch (...) {
    if (spans_ != nullptr) spans_->lost();
    throw;
  }
}

template <class Call>
auto MeteredBody::told(std::string_view what, Call&& call) {
  if (spans_ == nullptr) return call();
  spans_->asked(number_);
  if constexpr (std::is_void_v<decltype(call())>) {
    heard(call);
    spans_->answered(number_, what, 0.0);
  } else {
    auto answer = heard(call);
    spans_->answered(number_, what, 0.0);
    return answer;
  }
}

void MeteredBody::start(const Advance& request) {
  meter_.start();
  if (spans_ != nullptr) spans_->asked(number_);
  body_.start(request);
}

Outcome MeteredBody::finish(Response& response) {
  response.compute_seconds = 0.0;  // of a body that fails it would be an earlier one's
  Outcome outcome = heard([&] { return body_.finish(response); });
  meter_.finish(number_, response.compute_seconds);
  if (spans_ != nullptr) spans_->answered(number_, "advance", response.compute_seconds);
  return outcome;
}

PortKernel MeteredBody::probe(const Probing& asked) {
  const auto began = std::chrono::steady_clock::now();
  meter_.start();
  PortKernel kernel = told("probe", [&] { return body_.probe(asked); });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
  meter_.finish(number_, wall.count());
  return kernel;
}

void MeteredBody::meet(const Meeting& meeting) {
  told("meet", [&] { body_.meet(meeting); });
}

std::vector<std::byte> MeteredBody::checkpoint() {
  return told("state", [this] { return body_.checkpoint(); });
}

void MeteredBody::resume(std::span<const std::byte> bytes) {
  told("state", [&] { body_.resume(bytes); });
}

std::uint64_t MeteredBody::state_hash() {
  return told("state hash", [this] { return body_.state_hash(); });
}

std::vector<double> MeteredBody::measure() {
  return told("measures", [this] { return body_.measure(); });
}

std::vector<FieldValues> MeteredBody::fields() {
  return told("fields", [this] { return body_.fields(); });
}

// ---- passive form -------------------------------------------------------------------------------

PassiveForm* MeteredBody::passive() { return body_.passive() == nullptr ? nullptr : &passive_; }

double MeteredBody::Passive::enter() {
  body_.meter_.count(body_.number_);
  return body_.told("passive enter", [this] { return form().enter(); });
}

Outcome MeteredBody::Passive::leave(double time, double& lost) {
  body_.meter_.count(body_.number_);
  return body_.told("passive leave", [&] { return form().leave(time, lost); });
}

void MeteredBody::Passive::start(const PassiveStep& step) {
  body_.meter_.start();
  if (body_.spans_ != nullptr) body_.spans_->asked(body_.number_);
  form().start(step);
}

Outcome MeteredBody::Passive::finish(PassiveReply& reply) {
  reply.compute_seconds = 0.0;  // of a body that fails it would be an earlier one's
  Outcome outcome = body_.heard([&] { return form().finish(reply); });
  body_.meter_.finish(body_.number_, reply.compute_seconds);
  if (body_.spans_ != nullptr)
    body_.spans_->answered(body_.number_, "passive step", reply.compute_seconds);
  return outcome;
}

double MeteredBody::Passive::damp(double joules) {
  body_.meter_.count(body_.number_);
  return body_.told("passive damp", [&] { return form().damp(joules); });
}

std::vector<std::unique_ptr<Subdomain>> metered(const std::vector<Subdomain*>& bodies,
                                                BodyMeter& meter, SpanFile* spans) {
  std::vector<std::unique_ptr<Subdomain>> all;
  for (Subdomain* body : bodies)
    all.push_back(std::make_unique<MeteredBody>(*body, all.size(), meter, spans));
  return all;
}

}  // namespace abut
