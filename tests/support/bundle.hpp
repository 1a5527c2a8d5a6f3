#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// Bars side by side as one body, whose port has a point for every bar: as wide as they are many,
/// and what each point must do is known from the bar alone.
class Bundle : public Subdomain {
 public:
  /// Bars with one port each, at the same place.
  explicit Bundle(std::vector<std::unique_ptr<Subdomain>> bars)
      : bars_(std::move(bars)), requests_(bars_.size()), responses_(bars_.size()) {
    description_ = bars_[0]->describe();
    PortGeometry& surface = description_.ports[0].geometry;
    surface.points.assign(bars_.size(), surface.points[0]);
    surface.normals.assign(bars_.size(), surface.normals[0]);
    for (Advance& request : requests_) request.boundary.resize(1);
  }

  const Description& describe() const override { return description_; }
  void meet(const Meeting& meeting) override {
    if (meeting.surface == nullptr) return;
    for (std::size_t b = 0; b < bars_.size(); ++b) {
      PortGeometry point = *meeting.surface;
      point.points = {meeting.surface->points[b]};
      point.normals = {meeting.surface->normals[b]};
      bars_[b]->meet({meeting.port, meeting.partner, &point, meeting.law});
    }
  }
  void save() override {
    for (auto& bar : bars_) bar->save();
  }
  void restore() override {
    for (auto& bar : bars_) bar->restore();
  }
  void start(const Advance& request) override { request_ = &request; }
  [[nodiscard]] Outcome finish(Response& response) override {
    for (std::size_t b = 0; b < bars_.size(); ++b) {
      Advance& one = requests_[b];
      one.window = request_->window;
      one.records = request_->records;
      one.sampling = request_->sampling;
      one.boundary[0] = boundary_of(request_->boundary[0], b);
      Outcome outcome = bars_[b]->advance(one, responses_[b]);
      if (!std::holds_alternative<Advanced>(outcome)) return outcome;
    }
    response = responses_[0];
    PortResponse& port = response.ports[0];
    gather(port.trace, [](const PortResponse& p) -> const Waveform& { return p.trace; });
    for (std::size_t k = 0; k < port.reactions.size(); ++k) {
      gather(port.reactions[k].force,
             [k](const PortResponse& p) -> const Waveform& { return p.reactions[k].force; });
    }
    return Advanced{};
  }
  PortKernel probe(const Probing& asked) override {
    const auto& [port, patterns, step, count, seen] = asked;
    PortKernel all;  // bars do not feel each other
    for (std::size_t b = 0; b < bars_.size(); ++b) {
      const PortKernel one = bars_[b]->probe({port, {patterns[b]}, step, count});
      if (b == 0) all = one;
      all.width = static_cast<int>(bars_.size());
      all.displacement.resize(index(count) * bars_.size());
      for (std::size_t i = 0; i < index(count); ++i)
        all.displacement[i * bars_.size() + b] = one.displacement[i];
    }
    all.compliance.clear();
    all.begin.clear();
    return all;
  }
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte>) override {}
  std::uint64_t state_hash() override { return 0; }

 private:
  /// Column b of a wide waveform.
  Waveform point_of(const Waveform& wide, std::size_t b) const {
    Waveform one = wide;
    one.width = 1;
    for (std::vector<double> Waveform::*field :
         {&Waveform::u, &Waveform::v, &Waveform::a, &Waveform::f}) {
      const std::vector<double>& from = wide.*field;
      (one.*field).clear();
      for (std::size_t k = b; k < from.size(); k += bars_.size()) (one.*field).push_back(from[k]);
    }
    return one;
  }
  BoundaryData boundary_of(const BoundaryData& wide, std::size_t b) const {
    BoundaryData one;
    one.motion = point_of(wide.motion, b);
    for (const Waveform& force : wide.forces) one.forces.push_back(point_of(force, b));
    for (const Obstacle& o : wide.obstacles) one.obstacles.push_back({point_of(o.motion, b), {}});
    one.impedance = wide.impedance;
    return one;
  }
  template <class Part>
  void gather(Waveform& wide, const Part& part) const {
    wide.width = static_cast<int>(bars_.size());
    for (std::vector<double> Waveform::*field :
         {&Waveform::u, &Waveform::v, &Waveform::a, &Waveform::f}) {
      const std::size_t times = (part(responses_[0].ports[0]).*field).size();
      (wide.*field).resize(times * bars_.size());
      for (std::size_t b = 0; b < bars_.size(); ++b) {
        for (std::size_t i = 0; i < times; ++i)
          (wide.*field)[i * bars_.size() + b] = (part(responses_[b].ports[0]).*field)[i];
      }
    }
  }

  std::vector<std::unique_ptr<Subdomain>> bars_;
  Description description_;
  const Advance* request_ = nullptr;
  std::vector<Advance> requests_;
  std::vector<Response> responses_;
};

}  // namespace abut
