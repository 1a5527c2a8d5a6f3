#include "coordinator/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "base/endpoint.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_copies_spec.hpp"
#include "base/yaml_fields.hpp"
#include "coordinator/external_body.hpp"
#include "coordinator/port_roles.hpp"
#include "coordinator/scene_changes.hpp"
#include "coordinator/scene_times.hpp"
#include "coordinator/solver_processes.hpp"

namespace abut {

namespace {

/// Of deadlines [s]: a week is for ever, and milliseconds are counted.
constexpr const char* clock_seconds = "s (clock)";
constexpr Rule patience_rule{.low = 0.0, .high = 604'800.0, .above_low = true};

}  // namespace

void UntilContact::fields(Fields& f) {
  f.required("interface", interface, "",
             "name of a contact of interfaces, or everything: the stage ends before the window in "
             "which its sides may first touch");
}

void UntilApart::fields(Fields& f) {
  f.required("interface", interface, "",
             "name of a contact of interfaces, or everything: the stage ends with the window after "
             "which its sides, which have pressed in this stage, are too far apart to touch in the "
             "next one");
}

void TimeSpec::fields(Fields& f) {
  f.optional("begin", begin, "s", "time at which the run begins");
  f.required("end", end, "s", "time at which the run ends");
  f.required("window", window, "s", "length of the controller step, over which bodies are coupled",
             positive);
  f.choice("until", until, "event that ends the run or stage before its end");
  f.check(end > begin, "end",
          fmt::format("must be after begin, {:.6g} s, but is {:.6g} s", begin, end),
          "Give an end after the begin.");
}

void SpawnLaunch::fields(Fields& f) {
  f.optional(
      "program", program, "",
      "path of the solver program, from the folder in which abut is started; without a slash a "
      "name on the PATH; empty: abut-solver beside abut");
}

void ConnectLaunch::fields(Fields& f) {
  f.optional("patience", patience, clock_seconds, "time to wait for the body to connect",
             patience_rule);
}

void GroupLaunch::fields(Fields& f) {
  f.required("name", group, "",
             "name of the group, whose bodies share one process; launch: {group: NAME} is short "
             "for launch: {group: {name: NAME}}");
  f.optional("program", program, "", "the same for all bodies of the group: as spawn.program");
  f.check(!group.empty(), "name", "is empty", "Give the group a name.");
}

void BodyEntry::fields(Fields& f) {
  if (f.purpose() != Fields::Purpose::write)
    f.optional("like", like, "",
               "name of a body whose keys this one has beside its own: maps key by key, lists and "
               "values as a whole, a choice of another name instead; null leaves a key out");
  if (f.purpose() == Fields::Purpose::document) {  // the document has written copies out
    std::optional<CopiesSpec> copies;
    f.optional_section("copies", copies,
                       "many equal bodies: name_1, name_2, ..., with as many digits as the last "
                       "has, each with all keys of this one. Points and initial fields move with "
                       "them; loads and constraints stay where they are in space. None is turned: "
                       "spin stands in velocity_field, and a turned mesh is a body of its own");
  }
  f.choice("launch", launch, "way in which the body's process comes to life", Presence::optional);
  f.ignore_rest();
}

void NoAcceleration::fields(Fields&) {}

void RelaxationFactor::field(Fields& f, std::string_view key, double high, std::string_view help) {
  std::string text = probed() ? "probe" : fmt::format("{}", value);
  f.optional(key, text, "", help);
  if (f.purpose() != Fields::Purpose::read) return;
  double number = 0.0;
  const std::from_chars_result parsed =
      std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  f.check(text == "probe" || whole, key, fmt::format("must be a number or probe, but is {}", text),
          "Give the relaxation factor as a number, or probe.");
  f.check(!whole || (number > 0.0 && number <= high), key,
          fmt::format("must be above 0 and at most {:g}, but is {}", high, text),
          "Give the relaxation factor in this range, or probe.");
  value = whole ? number : 0.0;
}

void FixedRelaxation::fields(Fields& f) {
  factor.field(f, "factor", 2.0, "part of the correction that is taken, or probe");
}

void AitkenAcceleration::fields(Fields& f) {
  initial.field(f, "initial", 1.0,
                "relaxation factor of a window's first correction; probe: from the port kernels");
}

void AndersonAcceleration::fields(Fields& f) {
  initial.field(f, "initial", 1.0,
                "relaxation factor while there is no secant; probe: from the port kernels");
  f.optional("reuse", reuse, "", "number of earlier windows whose secants are kept",
             between(0, 100));
  f.optional("filter", filter, "", "relative size below which a secant is dropped",
             Rule{.low = 0.0, .high = 1.0, .below_high = true});
}

void KernelAcceleration::fields(Fields& f) {
  f.optional("reuse", reuse, "", "number of earlier windows whose secants are kept",
             between(0, 100));
  f.optional("filter", filter, "", "relative size below which a secant is dropped",
             Rule{.low = 0.0, .high = 1.0, .below_high = true});
}

void SchwarzSpec::fields(Fields& f) {
  f.word("form", parallel, {"alternating", "parallel"},
         "order of the bodies in an iteration: one after the other, or both at once");
  f.optional(
      "tolerance", tolerance, "",
      "largest residual of an exchanged field, relative to reference velocity x step; of statics "
      "also to the deformation by what presses",
      positive);
  f.optional("max_iterations", max_iterations, "",
             "number of iterations after which a window fails; absent: 20, 50 of bodies without "
             "inertia alone",
             between(1, 10000));
  f.choice("accelerator", accelerator, "choice of the next iterate", Presence::optional);
  f.optional_section("ties", ties, "kernels of tied surfaces, in two and three dimensions");
  f.idle(!std::holds_alternative<KernelAcceleration>(accelerator), "ties",
         "only the accelerator kernel uses kernels");
  f.word("on_nonconvergence", on_nonconvergence, {"passive", "stop", "halve", "accept"},
         "answer to a window that does not converge: end the run, halve the window, or go on");
  f.optional("energy_guard", energy_guard, "",
             "growth of the bodies' energy, less external work, that ends the run as failed, as a "
             "fraction of the most kinetic and stored energy so far; half of it is warned of",
             positive);
}

void FieldOutputSpec::fields(Fields& f) {
  f.required("every", every, "", "number of windows from one state that is written to the next",
             between(1, 1000000));
}

void MeasuresOutputSpec::fields(Fields& f) {
  f.required(
      "of", of, "",
      "names of measures that a body tells, with body.NAME. before them, as summary.json has "
      "them at the end: body.left.gauge.stress.xx of a port that is one node");
  f.optional("every", every, "", "number of windows from one row to the next", between(1, 1000000));
}

int OutputSpec::looked_at_every() const {
  const int fields_every = field_output ? field_output->every : 0;
  return std::gcd(fields_every, measures ? measures->every : 0);
}

void OutputSpec::fields(Fields& f) {
  f.optional("records_per_window", records_per_window, "",
             "number of rows of history.csv per controller window", between(1, 1000));
  f.optional_section("fields", field_output,
                     "fields of all bodies for ParaView (fields.pvd): at the begin, after every so "
                     "many windows and at the end; bodies fly free no further than that at once");
  f.optional_section(
      "measures", measures,
      "measures of bodies over time (measures.csv), as the stress at a gauge: at the "
      "begin, after every so many windows and at the end; bodies fly free no further "
      "than that at once");
  f.choice("force_filter", force_filter,
           "filter behind which the largest contact force is the measure "
           "contact.INTERFACE.force_peak_filtered");
  f.optional("steady_after", steady_after, "s",
             "time from which contact forces should not change: how much they do is the measure "
             "contact.INTERFACE.force_ripple");
  f.choice("checkpoint", checkpoint,
           "how often the whole run is kept, so that abut resume can go on from there, whatever "
           "ends it; the latest two stay. Without it the run is kept where a signal ends it");
}

void NetworkSpec::fields(Fields& f) {
  f.optional("endpoint", endpoint, "",
             "address at which bodies with launch: connect find the coordinator");
  f.optional("keys", keys, "",
             "folder with the keys of coordinator and bodies that abut keygen has made, from the "
             "scene's own folder: bodies with launch: connect come in with their keys alone, and "
             "what passes is encrypted; empty: no keys, on this machine alone");
  f.optional("request_deadline", request_deadline, clock_seconds,
             "time without a reply or a sign of progress after which a body is lost",
             patience_rule);
  f.optional("startup_deadline", startup_deadline, clock_seconds,
             "time within which a started process must report", patience_rule);
  f.optional("processes", processes, "",
             "number of processes to which the bodies are dealt in turns that the coordinator "
             "starts and that have neither a group nor a program of their own; 0: one for each",
             between(0, most_processes));
  f.word("on_lost_body", on_lost_body, {"stop", "restart"},
         "answer to a body that does not answer any more: end the run, or start all bodies again "
         "and go on from the latest checkpoint");
  f.word("transport", transport, {"automatic", "sockets"},
         "way of the messages of bodies: memory that the coordinator shares with each abut-solver "
         "that it starts, and sockets of ZeroMQ elsewhere; or sockets for all. Results are the "
         "same");
  const std::string_view wrong = wrong_endpoint(endpoint);
  f.check(wrong.empty(), "endpoint", fmt::format("must {}, but is {}", wrong, endpoint),
          "Give for example tcp://127.0.0.1:5555.");
}

void Scene::fields(Fields& f) {
  if (f.purpose() != Fields::Purpose::write || !units.empty())
    f.optional("units", units, "",
               "what numbers without a unit are in: SI, or a length, a mass and a time, as mm t s; "
               "numbers may have units of their own, as 210 GPa, which are converted");
  f.defaulted("meta", meta, "what the scene is and what it must produce");
  f.section("time", time, "interval of the run and its windows");
  f.map("bodies", bodies, "bodies, in the order of every table");
  f.map("interfaces", interfaces, "pairs of ports that may meet", Presence::optional);
  f.optional_section("contact", contact, "contact that is not written pair by pair");
  f.defaulted("schwarz", schwarz, "iteration inside a window in contact");
  f.defaulted("output", output, "what the run writes");
  f.defaulted("network", network, "addresses and deadlines");
  if (f.purpose() != Fields::Purpose::write)
    f.map("stages", stages,
          "stages that follow the scene as it is written, such as an impact after a preload: each "
          "begins with the state in which the one before it ends, and has keys of its own in place "
          "of the scene's: time.end, time.window, time.until, schwarz, output, and of bodies "
          "model, integrator, equations, contact_layer, and initial.velocity after a static state",
          Presence::optional);
  idle_keys(f);
}

void Scene::idle_keys(Fields& f) const {
  const bool iterated = everything() != nullptr ||
                        std::any_of(interfaces.begin(), interfaces.end(), [](const auto& entry) {
                          return !is_inside(entry.second.transmission);
                        });
  for (const char* key : {"form", "tolerance", "max_iterations", "accelerator"})
    f.idle(!iterated, std::string("schwarz.") + key, "no two bodies of the scene meet");
  const auto waits = [](const auto& entry) {
    return std::holds_alternative<ConnectLaunch>(entry.second.launch);
  };
  f.idle(std::none_of(bodies.begin(), bodies.end(), waits), "network.endpoint",
         "no body has launch: connect");
  f.idle(std::none_of(bodies.begin(), bodies.end(), waits), "network.keys",
         "no body has launch: connect");
  f.idle(std::all_of(bodies.begin(), bodies.end(), waits), "network.startup_deadline",
         "no body is started by the coordinator");
  f.idle(std::none_of(bodies.begin(), bodies.end(),
                      [](const auto& entry) { return starts_our_solver(entry.second); }),
         "network.transport", "the coordinator starts no abut-solver");
  f.idle(std::none_of(bodies.begin(), bodies.end(),
                      [](const auto& entry) { return is_dealt(entry.second); }),
         "network.processes", "every body has a group, a program or connect of its own");
}

PortName split_port(std::string_view text) {
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos) return {std::string(text), {}};
  return {std::string(text.substr(0, dot)), std::string(text.substr(dot + 1))};
}

namespace {

template <class Named>
std::string names_of(const Named& entries) {
  constexpr std::size_t most = 20;  // that anybody reads through
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries)
    if (names.size() < most) names.push_back(name);
  const std::size_t more = entries.size() - names.size();
  return fmt::format("{}{}", fmt::join(names, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

template <class Named>
bool has_name(const Named& entries, const std::string& name) {
  return std::any_of(entries.begin(), entries.end(),
                     [&name](const auto& entry) { return entry.first == name; });
}

void require_side(const InterfaceSpec& interface, const std::string& side, const std::string& path,
                  const Document& document) {
  if (side != interface.sides[0] && side != interface.sides[1])
    throw InputError(fmt::format("is {}, which is not a side of the interface", side),
                     document.where(path),
                     fmt::format("Choose {} or {}.", interface.sides[0], interface.sides[1]));
}

void validate_interface(const Scene& scene, const InterfaceSpec& interface,
                        const Document& document) {
  const std::string path = "interfaces." + interface.name;
  for (std::size_t i = 0; i < interface.sides.size(); ++i) {
    const std::string& side = interface.sides[i];
    const std::string where = document.where(fmt::format("{}.sides[{}]", path, i));
    const PortName name = split_port(side);
    if (name.body.empty() || name.port.empty() || name.port.find('.') != std::string::npos)
      throw InputError(fmt::format("is {}, which is not of the form body.port", side), where,
                       "Name a body and one of its ports, for example left.tip.");
    const std::string copies = document.copies_of(name.body);
    if (!copies.empty())
      throw InputError(fmt::format("is {}, but {} is written once for copies", side, name.body),
                       where, fmt::format("Name one of them: {}.", copies));
    if (!has_name(scene.bodies, name.body))
      throw InputError(fmt::format("is {}, but there is no body {}", side, name.body), where,
                       fmt::format("Choose one of the bodies: {}.", names_of(scene.bodies)));
  }
  const bool inside = is_inside(interface.transmission);
  const bool same = split_port(interface.sides[0]).body == split_port(interface.sides[1]).body;
  if (inside && interface.tied)
    throw InputError("is tied, but transmission internal is contact inside a body",
                     document.where(path + ".tied"), "Give contact: {}, or another transmission.");
  if (inside && !same)
    throw InputError("must be ports of one body when the transmission is internal",
                     document.where(path + ".sides"),
                     "Name left_tip and right_tip of a bar_pair, or another transmission.");
  if (!inside && same)
    throw InputError("must be ports of two different bodies", document.where(path + ".sides"),
                     "Name one port of each of the two bodies that meet.");
  if (const auto* u = std::get_if<UnilateralTransmission>(&interface.transmission))
    if (u->kinematic != "auto")
      require_side(interface, u->kinematic, path + ".transmission.unilateral.kinematic", document);
  if (const auto* d = std::get_if<DirichletNeumannTransmission>(&interface.transmission))
    require_side(interface, d->dirichlet, path + ".transmission.dirichlet_neumann.dirichlet",
                 document);
}

void validate_restart(const Scene& scene, const Document& document) {
  if (scene.network.on_lost_body == OnLostBody::stop || scene.output.checkpoint) return;
  throw InputError("is restart, but nothing is kept to go on from",
                   document.where("network.on_lost_body"),
                   "Give output: {checkpoint: {windows: N}}, or {wall: SECONDS}.");
}

void validate_steady_after(const Scene& scene, const Document& document) {
  const std::optional<double> after = scene.output.steady_after;
  if (!after || (!scene.interfaces.empty() && *after < scene.time.end)) return;
  throw InputError("has no effect: no contact force comes after it",
                   document.where("output.steady_after"),
                   "Give a time before time.end in a scene with interfaces, or leave it out.");
}

/// A filter that would see nothing of the run, or would take the run's time many times over.
void validate_force_filter(const Scene& scene, const Document& document) {
  if (!scene.output.force_filter) return;
  const std::string path = "output.force_filter";
  if (scene.interfaces.empty())
    throw InputError("has no effect: there is no interface whose force it could filter",
                     document.where(path), "Leave it out, or declare an interface.");
  const double run = scene.time.end - scene.time.begin;
  if (const MeanForceSpec* mean = std::get_if<MeanForceSpec>(&*scene.output.force_filter)) {
    const double least = 1.0e-9 * run;  // the round-off of times that sums of substeps have
    if (mean->time < least || mean->time > run)
      throw InputError(fmt::format("is {:g} s in a run of {:g} s", mean->time, run),
                       document.where(path + ".mean.time"),
                       fmt::format("Give a time from {:g} to {:g} s.", least, run));
    return;
  }
  const int of_class = std::get<ChannelClassSpec>(*scene.output.force_filter).channel_class;
  constexpr double most_samples = 1.0e9;  // some seconds of filtering
  const double longest = most_samples / (1000.0 * of_class);
  if (run > longest)
    throw InputError(
        fmt::format("is {}, which is for runs of up to {:g} s, but this one lasts {:g} s", of_class,
                    longest, run),
        document.where(path + ".cfc.class"),
        "Give a lower class, or {mean: {time: ...}}, whose cost does not grow.");
}

/// Two ports meet in one way.
void validate_pairs(const Scene& scene, const Document& document) {
  std::map<std::set<std::string>, std::string> used;  // sides to interface
  for (const auto& [name, interface] : scene.interfaces) {
    const std::set<std::string> sides(interface.sides.begin(), interface.sides.end());
    const auto [entry, fresh] = used.emplace(sides, name);
    if (!fresh)
      throw InputError(fmt::format("are {}, which the interface {} joins already",
                                   fmt::join(sides, " and "), entry->second),
                       document.where(fmt::format("interfaces.{}.sides", name)),
                       "Keep one of the two interfaces.");
  }
}

/// "a/two_bars.yaml" is "two_bars".
std::string stem_of(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  return name.substr(0, name.rfind('.'));
}

}  // namespace

std::vector<std::string> exact_interfaces(const Scene& scene) {
  std::vector<std::string> names;
  if (!scene.meta.closed_form) return names;
  if (const BarImpactForm* form = std::get_if<BarImpactForm>(&*scene.meta.closed_form)) {
    names.push_back(form->interface);
  } else {
    for (const auto& [name, interface] : scene.interfaces) names.push_back(name);
  }
  return names;
}

Scene read_scene(const Document& document) {
  InputErrors errors;
  Scene scene = read_scene(document, errors);
  errors.raise();
  return scene;
}

Scene read_scene(const Document& document, InputErrors& errors) {
  Scene scene;
  const std::size_t before = errors.count();
  errors.gather([&] { read_fields(document, "", [&scene](Fields& f) { scene.fields(f); }); });
  if (scene.meta.title.empty()) scene.meta.title = stem_of(document.name());
  for (auto& [name, entry] : scene.bodies) entry.external = is_external(document, name);
  assign_roles(scene, document);
  if (errors.count() == before) errors.gather([&] { validate(scene, document); });
  return scene;
}

void validate(const Scene& scene, const Document& document) {
  InputErrors errors;
  errors.gather([&] { check_times(scene.time, document); });
  errors.gather([&] { check_until(scene, document); });
  if (scene.bodies.empty())
    errors.add({"has no body", document.where("bodies"), "Give at least one body."});
  for (const auto& entry : scene.bodies)
    errors.gather([&] {
      check_external_launch(entry.second, document);
      check_external_like(entry.second, document);
    });
  errors.gather([&] { check_groups(scene, document); });
  for (const auto& entry : scene.interfaces)
    errors.gather([&] { validate_interface(scene, entry.second, document); });
  errors.gather([&] { validate_pairs(scene, document); });
  errors.gather([&] { validate_force_filter(scene, document); });
  errors.gather([&] { validate_steady_after(scene, document); });
  errors.gather([&] { validate_restart(scene, document); });
  errors.gather([&] { check_stages(document); });
  if (scene.meta.closed_form) {
    for (const std::string& name : exact_interfaces(scene))
      if (!has_name(scene.interfaces, name))
        errors.add({fmt::format("is {}, but there is no such interface", name),
                    document.where("meta.closed_form.bar_impact.interface"),
                    scene.interfaces.empty()
                        ? "Declare it under interfaces."
                        : fmt::format("Choose one of: {}.", names_of(scene.interfaces))});
    for (const auto& [name, entry] : scene.bodies) {
      if (!entry.external) continue;
      errors.add({fmt::format("describes bars and walls, but what the external body {} is, only "
                              "its own program knows",
                              name),
                  document.where("meta.closed_form"),
                  "Leave out meta.closed_form and the expectations that need it."});
    }
  }
  errors.raise();
}

}  // namespace abut
