// A mass on a spring as a body of abut, in a program of its own that links abut's libraries.
// usage: mass_on_spring --connect ENDPOINT --body NAME      (README.md beside this file)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/yaml_fields.hpp"
#include "contract/substeps.hpp"
#include "messaging/serve.hpp"
#include "messaging/zmq_dealer.hpp"

using namespace abut;

namespace {

/// The keys below model.external, read with file and line where they are wrong.
struct Keys {
  double mass = 0.0, stiffness = 0.0, position = 0.0, step = 0.0;

  void fields(Fields& f) {
    f.required("mass", mass, "kg", "what moves", positive);
    f.required("stiffness", stiffness, "N/m", "of the spring", positive);
    f.required("position", position, "m", "of the mass at rest");
    f.required("step", step, "s", "length of a substep", positive);
  }
};

/// Turns exactly on its spring; an impulse strikes in the middle of every substep.
class MassOnSpring : public Subdomain {
 public:
  explicit MassOnSpring(const Keys& keys)
      : keys_(keys), omega_(std::sqrt(keys.stiffness / keys.mass)) {
    description_.model = "mass on a spring, in C++";
    description_.dofs = 1;
    description_.mass = keys.mass;
    description_.step = keys.step;
    description_.stable_step = std::numeric_limits<double>::infinity();
    description_.conserves = true;
    description_.can.force = description_.can.kernel = true;
    Port face;
    face.name = "face";
    face.geometry.points = {keys.position};
    face.geometry.normals = {-1.0};
    description_.ports.push_back(face);
  }

  const Description& describe() const override { return description_; }
  void meet(const Meeting&) override {}  // it takes no obstacles
  void save() override { saved_ = state_; }
  void restore() override { state_ = saved_; }
  void start(const Advance& request) override { request_ = &request; }

  [[nodiscard]] Outcome finish(Response& response) override {
    const TimeWindow& window = request_->window;
    const double each = window.length() / request_->records;
    response.ports.resize(1);
    response.records.clear();
    PortResponse& port = response.ports.front();
    port = PortResponse{};
    port.trace.support = ForceSupport::step;
    tell(port.trace, window.begin);
    response.steps = 0;
    for (int record = 1; record <= request_->records; ++record) {
      const Substeps part = Substeps::divide(window.begin + (record - 1) * each,
                                             window.begin + record * each, keys_.step);
      double lowest = state_.u, highest = state_.u;
      for (int i = 1; i <= part.count; ++i) {
        port.work += substep(part.time(i - 1), part.time(i));
        lowest = std::min(lowest, state_.u), highest = std::max(highest, state_.u);
        const bool last = i == part.count;
        if (last || request_->sampling == Sampling::substeps)
          tell(port.trace, last && record == request_->records ? window.end : part.time(i));
      }
      response.steps += part.count;
      port.lower.push_back(keys_.position + lowest);
      port.upper.push_back(keys_.position + highest);
      response.records.push_back(record_at(window.begin + record * each));
    }
    response.records.back().time = window.end;
    port.speed_bound = std::hypot(state_.v, omega_ * state_.u);
    return Advanced{};
  }

  /// What a force over the first substep does, from rest.
  PortKernel probe(const Probing& asked) override {
    PortKernel kernel;
    kernel.step = asked.step;
    kernel.support = ForceSupport::step;
    kernel.patterns = static_cast<int>(asked.patterns.size());
    const double scale = asked.step / (keys_.mass * omega_);
    for (int i = 0; i < asked.count; ++i)
      for (const double force : asked.patterns)
        kernel.displacement.push_back(scale * force * std::sin((i + 0.5) * omega_ * asked.step));
    return kernel;
  }

  std::vector<std::byte> checkpoint() override {
    std::vector<std::byte> bytes;
    Archive archive = Archive::writer(bytes, Archive::Form::named);
    state_.state(archive);
    return bytes;
  }
  void resume(std::span<const std::byte> bytes) override {
    Archive archive = Archive::reader(bytes, Archive::Form::named);
    state_.state(archive);
    archive.finish();
  }
  std::uint64_t state_hash() override { return hash_state(state_); }

 private:
  struct State {
    double u = 0.0, v = 0.0, force = 0.0;  // [m] [m/s] [N], the force of the last substep

    void state(Archive& archive) {
      archive.field("u", u);
      archive.field("v", v);
      archive.field("force", force);
    }
  };

  /// Answers the energy that the impulse has brought.
  double substep(double from, double to) {
    double impulse = 0.0, part = 0.0;
    for (const Waveform& force : request_->boundary.front().forces) {
      if (force.empty()) continue;
      force.impulse(from, to, std::span<double>(&part, 1));
      impulse += part;
    }
    const double dt = to - from;
    turn(dt / 2);
    const double before = state_.v;
    state_.v += impulse / keys_.mass;
    const double work = impulse * (before + state_.v) / 2;
    turn(dt / 2);
    state_.force = impulse / dt;
    return work;
  }
  void turn(double time) {
    const double c = std::cos(omega_ * time), s = std::sin(omega_ * time);
    const double u = c * state_.u + s * state_.v / omega_;
    state_.v = c * state_.v - s * omega_ * state_.u;
    state_.u = u;
  }
  void tell(Waveform& trace, double time) const {
    trace.time.push_back(time);
    trace.u.push_back(state_.u);
    trace.v.push_back(state_.v);
    trace.a.push_back((state_.force - keys_.stiffness * state_.u) / keys_.mass);
    trace.f.push_back(state_.force);
  }
  BodyRecord record_at(double time) const {
    BodyRecord record;
    record.time = time;
    record.energy.kinetic = 0.5 * keys_.mass * state_.v * state_.v;
    record.energy.stored = 0.5 * keys_.stiffness * state_.u * state_.u;
    record.momentum = {keys_.mass * state_.v};
    return record;
  }

  Keys keys_;
  double omega_;  // [1/s]
  Description description_;
  State state_, saved_;
  const Advance* request_ = nullptr;
};

std::unique_ptr<Subdomain> make(const Specification& given, const ProgressHook&) {
  const Document scene = Document::from_text(given.document, given.text, given.overrides);
  return std::make_unique<MassOnSpring>(read<Keys>(scene, given.path + ".model.external"));
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> options;
  for (int i = 1; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  if (!options.contains("--connect") || !options.contains("--body")) {
    std::fputs("usage: mass_on_spring --connect ENDPOINT --body NAME [--keys DIR]\n", stderr);
    return 2;
  }
  const std::string &endpoint = options["--connect"], &body = options["--body"];
  try {
    const Limits limits;
    const Deadlines deadlines;
    ZmqDealer dealer(endpoint, body, limits, 1, Access{options["--keys"], false});
    CoordinatorLiveness coordinator(dealer, endpoint, deadlines);
    Server server(body, make, dealer, coordinator, limits, deadlines);
    serve(server, Milliseconds(60'000));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mass_on_spring: %s\n", error.what());
    return 3;
  }
}
