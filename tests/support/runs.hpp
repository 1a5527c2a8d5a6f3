#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/controller.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/record/measure_recorder.hpp"
#include "tests/support/solid_texts.hpp"

namespace abut {

/// A whole scene of bars and walls in a row, as a file would say it. Defaults: two_bars.yaml.
struct SceneText {
  struct Wall {
    double position = 0.0;
    std::string side;  // that it turns to the bars
  };

  std::vector<BarText> bars;
  std::optional<Wall> wall;
  std::vector<std::array<std::string, 2>> interfaces;  // body.port, named first, second, ...
  double begin = -2.0e-4, end = 8.0e-4, window = 1.0e-5;
  std::string transmission = "unilateral: {}";
  bool tied = false;    // all interfaces, instead of contact
  std::string schwarz;  // keys of that section
  bool closed_form = true;
  std::string form = "bar_impact: {interface: first}";

  std::string text() const {
    std::string out = "meta: {title: test";
    if (closed_form) out += fmt::format(", closed_form: {{{}}}", form);
    out += fmt::format("}}\ntime: {{begin: {}, end: {}, window: {}}}\nbodies:\n", number(begin),
                       number(end), number(window));
    for (const BarText& bar : bars) out += bar.text();
    if (wall) out += wall_text(wall->position, wall->side);
    if (!interfaces.empty()) out += "interfaces:\n";
    constexpr const char* names[] = {"first", "second", "third", "fourth"};
    for (std::size_t i = 0; i < interfaces.size(); ++i) {
      out +=
          fmt::format("  {}: {{sides: [{}, {}], {}: {{}}, transmission: {{{}}}}}\n", names[i],
                      interfaces[i][0], interfaces[i][1], tied ? "tied" : "contact", transmission);
    }
    if (!schwarz.empty()) out += fmt::format("schwarz: {{{}}}\n", schwarz);
    return out;
  }
};

/// The two bars of configs/two_bars.yaml, to be changed at will.
inline SceneText two_bars() {
  SceneText scene;
  BarText right;
  right.name = "right";
  right.position = 0.02;
  right.velocity = -100.0;
  right.sides = {"left"};
  scene.bars = {BarText(), right};
  scene.interfaces = {{"left.right", "right.left"}};
  return scene;
}

/// What a run leaves, window by window.
struct RunResult : Observer {
  struct Row {
    double time = 0.0;  // [s] end of the accepted window
    bool closed = false;
    int iterations = 0;
    std::vector<double> total;     // [J] by body
    std::vector<double> momentum;  // [kg m/s] by body
    std::vector<double> work;      // [J] external, by body: a tool's is what drives it
    std::vector<double> u, f;      // [m] [N] of first ports at the window's end
  };
  RunEnd end;
  Measures measures;
  std::vector<Row> rows;
  std::vector<RunEvent> events;
  std::vector<double> masses;

  void on_start(const RunStart& start) override {
    for (const Description* body : start.bodies) masses.push_back(body->mass);
  }
  void on_window(const WindowReport& report) override {
    Row row;
    row.time = report.window.end;
    for (const InterfaceReport& i : report.interfaces) {
      row.closed = row.closed || i.closed;
      row.iterations = std::max(row.iterations, i.iterations);
    }
    for (const Response& r : report.responses) {
      row.total.push_back(r.records.back().energy.total());
      row.momentum.push_back(r.records.back().momentum[0]);
      row.work.push_back(r.records.back().energy.external_work);
      if (r.ports.empty()) continue;
      row.u.push_back(r.ports[0].trace.u.back());
      row.f.push_back(r.ports[0].trace.f.back());
    }
    rows.push_back(row);
  }
  void on_event(const RunEvent& event) override { events.push_back(event); }
  void on_end(const RunEnd& e) override { end = e; }

  double measure(const std::string& name) const { return measures.values.at(name); }
  bool completed() const { return end.status == "completed"; }
  /// Mean velocity of a body at the end [m/s].
  double velocity(std::size_t body) const { return rows.back().momentum[body] / masses[body]; }
  /// Largest change of the total momentum over the largest momentum of a body at the start.
  double momentum_error() const {
    double scale = 0.0, first = 0.0, most = 0.0;
    for (double p : rows.front().momentum) {
      scale = std::max(scale, std::abs(p));
      first += p;
    }
    for (const Row& row : rows) {
      double sum = 0.0;
      for (double p : row.momentum) sum += p;
      most = std::max(most, std::abs(sum - first));
    }
    return most / scale;
  }
  /// Total energy at the end over that of the start, less 1.
  double energy_error() const {
    double first = 0.0, last = 0.0;
    for (double e : rows.front().total) first += e;
    for (double e : rows.back().total) last += e;
    return last / first - 1.0;
  }
  /// Times of events of a kind at an interface.
  std::vector<double> times(RunEvent::Kind kind, const std::string& interface) const {
    std::vector<double> out;
    for (const RunEvent& event : events) {
      if (event.kind == kind && event.subject == interface) out.push_back(event.time);
    }
    return out;
  }
};

using ResultPtr = std::unique_ptr<RunResult>;

/// `also`: sees the run, too; may be null.
inline ResultPtr run_document(const Document& document, Observer* also = nullptr) {
  const Scene scene = read_scene(document);
  const std::vector<std::unique_ptr<Subdomain>> bodies = launch_local(scene, document);
  std::vector<Subdomain*> pointers;
  std::vector<const Description*> descriptions;
  for (const std::unique_ptr<Subdomain>& body : bodies) {
    pointers.push_back(body.get());
    descriptions.push_back(&body->describe());
  }
  validate_bodies(scene, descriptions, document);
  const std::optional<ClosedForm> form = make_closed_form(scene, descriptions, document);
  std::unique_ptr<RunResult> result = std::make_unique<RunResult>();
  MeasureRecorder recorder(form ? &*form : nullptr, scene.output.force_filter,
                           scene.output.steady_after);
  std::vector<Observer*> observers = {&recorder, result.get()};
  if (also != nullptr) observers.push_back(also);
  Controller(scene, pointers, observers).run();
  result->measures = recorder.measures();
  return result;
}

/// Runs a scene as a file would say it.
inline ResultPtr run_text(const std::string& text, Observer* also = nullptr) {
  return run_document(Document::from_text("test", text), also);
}

/// Runs a scene that begins at time 0 (scene_text).
inline ResultPtr run_scene(double end, double window, const std::string& bodies,
                           const std::string& rest = "") {
  return run_text(scene_text(end, window, bodies, rest));
}

/// A run of such bodies from time 0 in windows of one length; `rest`: other sections.
inline ResultPtr run_solids(double end, double window, const std::vector<SolidText>& bodies,
                            const std::string& interfaces = "", const std::string& rest = "") {
  return run_scene(end, window, texts_of(bodies),
                   (interfaces.empty() ? "" : "interfaces:\n" + interfaces) + rest);
}

/// Runs a scene in this process. Throws what the scene's reader throws.
inline ResultPtr run(const SceneText& scene) { return run_text(scene.text()); }

/// Runs a shipped scene with values put in place of its own.
inline ResultPtr run_file(const std::string& path, std::vector<std::string> overrides = {}) {
  return run_document(Document::load(path, std::move(overrides)));
}

}  // namespace abut
