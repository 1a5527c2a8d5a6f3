#include "coordinator/probed_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "base/error.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/metered_body.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/vtk_fields.hpp"

namespace abut {

namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int enough_windows = 3;
constexpr double times_as_long = 2.5;      // for so many
constexpr double times_for_contact = 4.0;  // for so many in contact, which may cost ten of flight

double seconds_since(SteadyClock::time_point time) {
  return std::chrono::duration<double>(SteadyClock::now() - time).count();
}

/// Something pressed in it: surfaces that are near are iterated before they do, at the cost of
/// flight.
bool presses(const WindowReport& report) {
  const auto acts = [](double force) { return force != 0.0; };
  return std::ranges::any_of(report.responses, [&](const Response& response) {
    return std::ranges::any_of(response.ports, [&](const PortResponse& port) {
      return std::ranges::any_of(port.trace.f, acts) ||
             std::ranges::any_of(port.reactions, [&](const Reaction& reaction) {
               return std::ranges::any_of(reaction.force.f, acts);
             });
    });
  });
}

/// A folder of this user alone, which is gone at the end.
class PassingFolder {
 public:
  PassingFolder() {
    std::error_code ignored;
    std::string name = (std::filesystem::temp_directory_path(ignored) / "abut-XXXXXX").string();
    if (!ignored && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~PassingFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }  // empty: none could be made

 private:
  std::filesystem::path path_;
};

/// Notes what windows cost, and states of fields beside them.
class Notes : public Observer {
 public:
  Notes(const Scene& scene, const std::vector<Subdomain*>& bodies) {
    const std::optional<FieldOutputSpec>& wanted = scene.output.field_output;
    if (!wanted || folder_.path().empty()) return;
    fields_.emplace(folder_.path(), bodies, wanted->every);
    probe.states_apart = wanted->every * scene.time.window;
  }
  void on_start(const RunStart& start) override {
    probe.begin = probe.reached = start.begin;
    write([&] { fields_->on_start(start); });
    last_ = SteadyClock::now();
  }
  void on_window(const WindowReport& report) override {
    const double wall = seconds_since(last_);
    write([&] { fields_->on_window(report); });
    last_ = SteadyClock::now();
    probe.reached = report.window.end;
    if (report.window.length() <= 0.0) return;
    ProbedRun::Stretch stretch{report.window.length(), wall, presses(report), 1};
    for (const InterfaceReport& interface : report.interfaces)
      stretch.iterations = std::max(stretch.iterations, interface.iterations);
    probe.stretches.push_back(stretch);
    if (stretch.closed) ++pressed;
    ended = static_cast<int>(probe.stretches.size());
  }
  void on_event(const RunEvent& event) override {
    if (event.kind == RunEvent::Kind::failure) probe.failure = event.text;
  }

  ProbedRun probe;
  std::atomic<int> ended = 0, pressed = 0;  // windows, for who watches the clock

 private:
  /// A folder that is full is none of the run's, which may write elsewhere.
  void write(const std::function<void()>& part) {
    if (!fields_) return;
    const SteadyClock::time_point began = SteadyClock::now();
    try {
      part();
    } catch (const RunError&) {
      fields_.reset();
      return;
    }
    written_ += seconds_since(began);
    const double states = 1.0 + std::floor((probe.reached - probe.begin) / probe.states_apart);
    probe.state_wall = written_ / states;
  }

  PassingFolder folder_;
  std::optional<VtkFields> fields_;
  double written_ = 0.0;  // [s] of the clock
  SteadyClock::time_point last_;
};

}  // namespace

ProbedRun probe_run(const Scene& scene, const std::vector<Subdomain*>& bodies, double seconds,
                    std::atomic<bool>& stop, const std::atomic<bool>& interrupted, bool touches) {
  Notes notes(scene, bodies);
  BodyMeter meter(bodies.size());
  const std::vector<std::unique_ptr<Subdomain>> measured = metered(bodies, meter);
  std::vector<Subdomain*> all;
  for (const std::unique_ptr<Subdomain>& body : measured) all.push_back(body.get());
  const SteadyClock::time_point began = SteadyClock::now();
  std::atomic<bool> over = false;
  std::thread watch([&] {
    while (!over) {
      const double time = seconds_since(began);
      const double longer = notes.ended < enough_windows                ? times_as_long
                            : touches && notes.pressed < enough_windows ? times_for_contact
                                                                        : 1.0;
      if (interrupted || time > longer * seconds) stop = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  try {
    const RunEnd end = Controller(scene, all, {&notes}, &stop).run();
    notes.probe.whole = end.status == "completed";
  } catch (const RunError& error) {
    if (!stop) notes.probe.failure = error.what();
  } catch (const InputError& error) {
    notes.probe.failure = error.what();
  } catch (...) {
    over = true;
    watch.join();
    throw;
  }
  over = true;
  watch.join();
  if (stop) notes.probe.failure.clear();  // it was broken off, wherever it was
  notes.probe.wall = seconds_since(began);
  notes.probe.waited_seconds = meter.waited_seconds();
  return notes.probe;
}

}  // namespace abut
