#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "coordinator/exact/closed_form.hpp"
#include "coordinator/record/observer.hpp"

namespace abut {

/// A hand-made run of two bars of length, impedance and wave speed 1 that meet at (+-)1 m/s: gap
/// 0.2 m from time 0 on, contact from 0.1 to 2.1 s with force 1 N. Windows hold equal substeps, two
/// unless told otherwise, and one record.
class HandMadeRun {
 public:
  using Field = std::function<double(int side, double time)>;

  HandMadeRun() : form(make_form()), responses(2), interfaces(1) {
    for (const int side : {0, 1}) {
      Description& body = bodies[side];
      body.name = side == 0 ? "left" : "right";
      body.mass = 1.0;
      Port port;
      port.name = "tip";
      port.geometry.points = {side == 0 ? -0.1 : 0.1};
      port.geometry.normals = {side == 0 ? 1.0 : -1.0};
      body.ports.push_back(port);
      responses[side].ports.resize(1);
    }
    start.begin = 0.0;
    start.end = 3.0;
    start.bodies = {&bodies[0], &bodies[1]};
    start.interfaces = {{"impact", {0, 1}, {0, 0}, 0.2}};
    u = [this](int side, double time) { return form.row.displacement(end_at(side), time); };
    v = [this](int side, double time) { return form.row.velocity(end_at(side), time); };
    f = [this](int side, double time) { return form.row.force(end_at(side), time); };
    kinetic = [this](int side, double time) { return form.row.kinetic(side, time); };
    stored = [this](int side, double time) { return form.row.stored(side, time); };
    momentum = [this](int side, double time) { return form.row.momentum(side, time); };
  }
  HandMadeRun(const HandMadeRun&) = delete;
  HandMadeRun& operator=(const HandMadeRun&) = delete;

  static BarEnd end_at(int side) { return {side, 1 - side}; }

  static ClosedForm make_form() {
    RowBar left;
    left.name = "left";
    left.youngs_modulus = left.density = left.area = left.length = left.velocity = 1.0;
    left.position = -1.1;
    RowBar right = left;
    right.name = "right";
    right.position = 0.1;
    right.velocity = -1.0;
    return {"bar_impact",
            bar_impact({left, right}, {end_at(0), end_at(1)}, 0.0, 3.0),
            {"impact"},
            {"left", "right"}};
  }

  void window(Observer& observer, double begin, double end, bool closed, int iterations = 0) {
    for (const int side : {0, 1}) fill(side, begin, end);
    interfaces[0] = {closed, kinematic, iterations, 0.0};
    observer.on_window({{index++, begin, end}, responses, interfaces});
  }

  void event(Observer& observer, RunEvent::Kind kind, double time) {
    observer.on_event({kind, time, "impact", "", {}});
  }

  /// The whole exact run in windows of 0.1 s: 1 free, 20 closed with 2 iterations each, 9 free.
  /// The same times without the contact, if there is to be none.
  void play(Observer& observer, bool contact = true) {
    observer.on_start(start);
    for (int k = 0; k < 30; ++k) {
      const bool closed = contact && k >= 1 && k < 21;
      if (contact && k == 1) event(observer, RunEvent::Kind::contact_closed, 0.1);
      if (contact && k == 21) event(observer, RunEvent::Kind::contact_opened, 2.1);
      window(observer, 0.1 * k, 0.1 * (k + 1), closed, closed ? 2 : 0);
    }
    observer.on_end(end());
  }

  RunEnd end() const {
    RunEnd end;
    end.status = "completed";
    end.time = 3.0;
    end.state_hash = 0xabcULL;
    end.body_hashes = {0x1ULL, 0x2ULL};
    end.windows = index;
    end.contact_windows = 20;
    end.exchanges = 142;
    end.wall_seconds = 0.5;
    end.compute_seconds = {0.125, 0.25};
    end.overhead_median_seconds = 2e-5;
    return end;
  }

  ClosedForm form;
  Description bodies[2];
  RunStart start;
  Field u, v, f, kinetic, stored, momentum;
  Field dissipated = [](int, double) { return 0.0; };
  Field told = [](int, double time) { return time; };  // in every column of the body's own
  ForceSupport support = ForceSupport::step;
  int substeps = 2;   // in a window
  int kinematic = 0;  // side
  std::vector<Response> responses;
  std::vector<InterfaceReport> interfaces;
  std::int64_t index = 0;

 private:
  void fill(int side, double begin, double end) {
    PortResponse& reply = responses[side].ports[0];
    Waveform& trace = reply.trace;
    trace.clear();
    trace.support = support;
    double most = -std::numeric_limits<double>::infinity();
    const double length = (end - begin) / substeps;
    for (int k = 0; k <= substeps; ++k) {
      const double time = k == substeps ? end : begin + k * length;
      trace.time.push_back(time);
      trace.u.push_back(u(side, time));
      trace.v.push_back(v(side, time));
      // A force that is constant over a substep is that of the substep's middle.
      const double shift = support == ForceSupport::step ? 0.5 * length : 0.0;
      trace.f.push_back(f(side, time - shift));
      most = std::max(most, trace.u.back());
    }
    reply.upper = {most + (side == 0 ? -0.1 : 0.1)};  // a position
    BodyRecord record;
    record.time = end;
    record.energy.kinetic = kinetic(side, end);
    record.energy.stored = stored(side, end);
    record.energy.dissipated = dissipated(side, end);
    record.momentum = {momentum(side, end)};
    record.columns.assign(bodies[side].columns.size(), told(side, end));
    responses[side].records = {record};
  }
};

}  // namespace abut
