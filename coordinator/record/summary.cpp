#include "coordinator/record/summary.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/archive_lists.hpp"
#include "base/error.hpp"
#include "base/unit_words.hpp"
#include "coordinator/record/expectations.hpp"
#include "coordinator/record/given_up_words.hpp"
#include "coordinator/record/run_facts.hpp"
#include "coordinator/record/swaps_json.hpp"
#include "coordinator/record/text_file.hpp"
#include "coordinator/record/validity_notes.hpp"

namespace abut {
namespace {

// An object or array is made before its members are: where memory fails between, the library
// leaves a value that it cannot destroy.
using Json = nlohmann::ordered_json;

Json measures_object(const Measures& measures, Json& notes) {
  std::vector<std::pair<std::string, Json>> object;  // taken as it is: no search for each name
  for (const auto& [name, value] : measures.values) object.emplace_back(name, json_number(value));
  for (const auto& [name, why] : measures.notes) notes.push_back(name + ": " + why);
  return Json::object_t(object.begin(), object.end());
}

Json expectations_array(const std::vector<Expectation>& expectations, const Measures& measures,
                        Json& notes) {
  Json array = Json::array();
  for (const Expectation& expectation : expectations) {
    // One by one: an unknown name is the caller's error to report and must not cost the summary.
    try {
      const ExpectationResult result = evaluate({expectation}, measures).front();
      array.push_back({{"measure", result.measure},
                       {"expected", result.expected},
                       {"got", json_number(result.got)},
                       {"pass", result.pass},
                       {"because", result.because}});
    } catch (const InputError& error) {
      notes.push_back(error.what());
    }
  }
  return array;
}

Json contact_object(const RowContact& contact) {
  Json object = {{"count", contact.count()}};
  if (!contact.ever()) return object;
  object["begin"] = contact.begin();
  object["end"] = contact.pressed_at_end ? Json(nullptr) : Json(contact.end());
  object["duration"] = contact.pressed_at_end ? Json(nullptr) : Json(contact.duration());
  object["force"] = contact.force_peak();
  object["impulse"] = contact.impulse();
  return object;
}

/// Of bar_impact the one contact, beside the name; else all, by interface.
Json closed_form_object(const ClosedForm& form) {
  const BarRow& row = form.row;
  Json object = {{"name", form.name}};
  const bool single = form.name == BarImpactForm::name;
  if (single) {
    object["interface"] = form.interfaces[0];
    object.update(contact_object(row.contacts()[0]));
  }
  object["closing_speed"] = row.velocity_spread();
  if (!single) object["interfaces"] = Json::object();
  for (std::size_t i = 0; !single && i < form.interfaces.size(); ++i)
    object["interfaces"][form.interfaces[i]] = contact_object(row.contacts()[i]);
  object["bodies"] = Json::object();
  for (int b = 0; b < row.bars(); ++b)
    object["bodies"][form.bodies[b]] = {
        {"wall", row.bar(b).wall},
        {"mean_velocity_end", json_number(row.mean_velocity(b, row.end()))},
        {"total_begin", json_number(row.total(b, row.begin()))},
        {"total_end", json_number(row.total(b, row.end()))}};
  return object;
}

/// [J] that the errors of energies are relative to; for pages of curves.
Json energy_scales_object(const Measures& measures) {
  Json object = {{"total", json_number(measures.total_energy_scale)}, {"bodies", Json::object()}};
  for (const auto& [body, scale] : measures.energy_scales)
    object["bodies"][body] = json_number(scale);
  return object;
}

Json timing_object(const RunEnd& end, const RunStart& start, const std::vector<double>* waited) {
  Json timing = {{"wall_s", json_number(end.wall_seconds)}, {"compute_s", Json::object()}};
  for (std::size_t b = 0; b < std::min(start.bodies.size(), end.compute_seconds.size()); ++b)
    timing["compute_s"][start.bodies[b]->name] = json_number(end.compute_seconds[b]);
  double coupling = end.wall_seconds;
  if (waited != nullptr) timing["waited_s"] = Json::object();
  for (std::size_t b = 0; waited != nullptr && b < start.bodies.size(); ++b) {
    timing["waited_s"][start.bodies[b]->name] = json_number((*waited)[b]);
    coupling -= (*waited)[b];
  }
  if (waited != nullptr) timing["coupling_s"] = json_number(std::max(0.0, coupling));
  timing["overhead_per_exchange_us_median"] = json_number(1e6 * end.overhead_median_seconds);
  return timing;
}

Json estimate_object(const Estimate& estimate) {
  Json bodies = Json::object();
  for (const Estimate::Body& body : estimate.bodies) {
    bodies[body.name] = {{"dofs", body.dofs},
                         {"substeps", body.substeps},
                         {"memory_mib", json_number(body.memory_mib)}};
  }
  Json kernels = Json::object();
  for (const Estimate::Kernel& kernel : estimate.kernels) {
    kernels[kernel.interface] = {{"points", kernel.points},
                                 {"points_that_fit", kernel.points_that_fit},
                                 {"memory_mib", json_number(kernel.memory_mib)}};
  }
  Json ties = Json::array();
  for (const Estimate::Ties& net : estimate.ties) {
    Json rows = Json::object();
    for (const Estimate::Ties::Joint& joint : net.joints) rows[joint.interface] = joint.rows;
    const auto [low, high] = net.calls();
    ties.push_back({{"rows", rows},
                    {"calls", {low, high ? Json(*high) : Json(nullptr)}},
                    {"banded", net.banded},
                    {"memory_mib", json_number(net.memory_mib)},
                    {"probes", net.probes}});
  }
  return {{"windows", estimate.windows},
          {"contact_windows", {estimate.contact_windows_low, estimate.contact_windows_high}},
          {"exchanges", {estimate.exchanges_low, estimate.exchanges_high}},
          {"bodies", bodies},
          {"kernels", kernels},
          {"ties", ties},
          {"in_use", estimate.in_use},
          {"not_built", estimate.not_built}};
}

Json overlaps_array(const RunEnd& end, const RunStart& start) {
  Json array = Json::array();
  for (const Overlap& overlap : end.overlaps) {
    const Description &one = *start.bodies[overlap.body[0]],
                      &other = *start.bodies[overlap.body[1]];
    Json entry = {{"bodies", {one.name, other.name}},
                  {"depth", json_number(overlap.depth)},
                  {"time", json_number(overlap.time)},
                  {"place", Json::array()}};
    for (int i = 0; i < one.dim; ++i) entry["place"].push_back(json_number(overlap.place[i]));
    array.push_back(entry);
  }
  return array;
}

Json by_body(const std::vector<double>& values, const RunStart& start) {
  Json object = Json::object();
  for (std::size_t b = 0; b < values.size(); ++b)
    if (values[b] != 0.0) object[start.bodies[b]->name] = json_number(values[b]);
  return object;
}

Json given_up_object(const RunEnd& end, const RunStart& start,
                     const std::map<std::string, std::string>& units) {
  const GivenUp& up = end.given_up;
  Json object = {{"passive_windows", up.windows},
                 {"halved_windows", up.halved_windows},
                 {"rigid_windows", up.rigid_windows},
                 {"unanswered", up.unanswered},
                 {"near_windows", up.near_windows},
                 {"missed", json_number(up.missed)},
                 {"passive_steps", up.steps},
                 {"refused_steps", up.refused},
                 {"held_rigid", up.rigid},
                 {"shortest_step", json_number(up.shortest_step)},
                 {"unsettled_steps", up.unsettled},
                 {"unbalanced", json_number(up.unbalanced)},
                 {"joules", json_number(up.joules())},
                 {"largest_energy", json_number(up.largest)},
                 {"normal", json_number(up.normal)},
                 {"impacts", json_number(up.impacts)},
                 {"friction", json_number(up.friction)},
                 {"damped", json_number(up.damped)},
                 {"changes_of_form", json_number(up.switched)},
                 {"push_out", json_number(up.push_out)},
                 {"taken_back", json_number(up.taken_back)},
                 {"owed", json_number(up.owed)},
                 {"repaid", json_number(up.repaid)},
                 {"deepest", json_number(up.deepest)},
                 {"lost_by_body", by_body(up.lost, start)},
                 {"taken_from_body", by_body(up.taken, start)},
                 {"refused_by_body", by_body(up.refused_by, start)},
                 {"words", quantities_in(units, given_up_words(up, end.windows, start.bodies))}};
  if (const std::optional<GivenUpRemedy> remedy = remedy_of(up))
    object["remedy"] = {{"body", start.bodies[static_cast<std::size_t>(remedy->body)]->name},
                        {"change", remedy->finer_mesh ? "finer mesh" : "smaller steps"}};
  return object;
}

}  // namespace

Summary::Summary(std::filesystem::path directory, Heading heading, const MeasureRecorder& recorder,
                 const ClosedForm* form)
    : directory_(std::move(directory)),
      heading_(std::move(heading)),
      recorder_(recorder),
      form_(form) {}

void Summary::state(Archive& archive) {
  list(archive, "swaps", swaps_, [](Archive& a, Swap& swap) { swap.state(a); });
}

void Summary::on_start(const RunStart& start) {
  start_ = start;
  if (!heading_.program_began) return;
  const Clock::Duration startup = SystemClock().now() - *heading_.program_began;
  startup_seconds_ = std::chrono::duration<double>(startup).count();
}

std::string Summary::text(const RunEnd& end) const {
  Json notes = Json::array();
  if (!recorder_.non_finite().empty()) notes.push_back(recorder_.non_finite());
  Json summary = Json::object();
  summary["status"] = status_;
  if (!end.reason.empty()) summary["reason"] = end.reason;
  summary["title"] = heading_.title;
  summary["time"] = {
      {"begin", start_.begin}, {"end", start_.end}, {"reached", json_number(end.time)}};
  if (!heading_.units.empty()) summary["units"] = heading_.units;
  summary["measures"] = measures_object(recorder_.measures(), notes);
  summary["expectations"] = expectations_array(heading_.expectations, recorder_.measures(), notes);
  summary["energy_scales"] = energy_scales_object(recorder_.measures());
  if (form_ != nullptr) summary["closed_form"] = closed_form_object(*form_);
  summary["state_hash"] =
      end.state_hash ? Json(fmt::format("{:016x}", *end.state_hash)) : Json(nullptr);
  if (!end.body_hashes.empty()) summary["body_hashes"] = Json::object();
  for (std::size_t b = 0; b < end.body_hashes.size(); ++b)
    summary["body_hashes"][start_.bodies[b]->name] = fmt::format("{:016x}", end.body_hashes[b]);
  summary["windows"] = end.windows;
  summary["contact_windows"] = end.contact_windows;
  summary["exchanges"] = end.exchanges;
  if (!swaps_.empty()) summary["swaps"] = swaps_json(swaps_);
  summary["overlaps"] = overlaps_array(end, start_);
  summary["never_closed"] = end.never_met;
  summary["accuracy"] = {{"given_up", given_up_object(end, start_, heading_.units)}};
  summary["timing"] = timing_object(end, start_, heading_.waited);
  if (heading_.program_began) summary["timing"]["startup_s"] = json_number(startup_seconds_);
  if (heading_.estimate) summary["estimate"] = estimate_object(*heading_.estimate);
  summary["bodies"] = bodies_json(start_, heading_.units);
  summary["ports"] = ports_json(start_);
  summary["interfaces"] = interfaces_json(start_);
  summary["versions"] = heading_.versions;
  for (std::size_t b = 0; b < std::min(start_.bodies.size(), end.body_measures.size()); ++b)
    for (const std::string& note : validity_notes(*start_.bodies[b], end.body_measures[b]))
      notes.push_back(quantities_in(heading_.units, note));
  summary["notes"] = notes;
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void Summary::on_end(const RunEnd& end) {
  status_ = recorder_.non_finite().empty() ? end.status : "failed";
  write_whole(directory_ / "summary.json", text(end));
}

}  // namespace abut
