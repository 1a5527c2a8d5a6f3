#include "coordinator/record/many_contacts.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/archive_lists.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

std::array<int, 4> key_of(const PairReport& pair) {
  return {pair.body[0], pair.port[0], pair.body[1], pair.port[1]};
}

}  // namespace

ManyContacts::ManyContacts(const RunStart& start, int interface)
    : start_(start), index_(interface) {}

void ManyContacts::on_event(const RunEvent& event) {
  if (event.subject != start_.interfaces[index_].name) return;
  if (event.kind == RunEvent::Kind::contact_closed) {
    begin_ = closings_ == 0 ? event.time : std::min(begin_, event.time);
    ++closings_;
    ++open_;
  } else if (event.kind == RunEvent::Kind::contact_opened) {
    end_ = std::max(end_, event.time);
    --open_;
  }
}

void ManyContacts::on_window(const WindowReport& report) {
  for (const PairReport& pair : report.pairs) {
    if (pair.interface != index_) continue;
    dissipated_[key_of(pair)] = pair.dissipated;
    const std::size_t k = index(pair.kinematic);
    const PortResponse& reply = report.responses[pair.body[k]].ports[pair.port[k]];
    const std::size_t partner = index(pair.partner[k]);
    if (partner >= reply.reactions.size() || reply.reactions[partner].force.empty()) continue;
    const Reaction& reaction = reply.reactions[partner];
    const PortReader reader(start_.bodies[pair.body[k]]->ports[pair.port[k]]);
    const PortGeometry& other = start_.bodies[pair.body[1 - k]]->ports[pair.port[1 - k]].geometry;
    read_force(reaction.force, reader, other, taken_back_[key_of(pair)]);
  }
}

/// A force of steps is that of the step that ends at its time.
void ManyContacts::read_force(const Waveform& force, const PortReader& reader,
                              const PortGeometry& partner, TakenBack& taken) {
  if (force.f.empty()) return;
  const bool nodal = force.support != ForceSupport::step;
  double before = reader.compression(force, 0);
  if (nodal) peak_ = std::max(peak_, before);
  for (std::size_t i = 1; i < force.size(); ++i) {
    const double now =
        taken.sign(force, reader.port().geometry, partner, i) * reader.compression(force, i);
    impulse_ += 0.5 * ((nodal ? before : now) + now) * (force.time[i] - force.time[i - 1]);
    peak_ = std::max(peak_, now);
    before = now;
  }
}

void ManyContacts::write(Measures& out) const {
  const auto name = [this](const char* what) {
    return fmt::format("contact.{}.{}", start_.interfaces[index_].name, what);
  };
  double dissipated = 0.0;
  for (const auto& [pair, heat] : dissipated_) dissipated += heat;
  out.set(name("impulse"), impulse_);
  out.set(name("force_peak"), peak_);
  out.set(name("dissipated"), dissipated);
  out.set(name("closings"), closings_);
  out.set(name("count"), closings_);
  const std::string never = "no two surfaces touched", many = "it is of many pairs";
  if (closings_ > 0) {
    out.set(name("begin"), begin_);
  } else {
    out.none(name("begin"), never);
  }
  if (closings_ > 0 && open_ == 0) {
    out.set(name("end"), end_);
    out.set(name("duration"), end_ - begin_);
  } else {
    const std::string why = closings_ > 0 ? "surfaces touched when the run ended" : never;
    out.none(name("end"), why);
    out.none(name("duration"), why);
  }
  for (const char* what : {"force_mean", "velocity_rms", "gap_min", "jump_max"})
    out.none(name(what), many);
}

void ManyContacts::state(Archive& archive) {
  std::vector<std::pair<std::array<int, 4>, double>> rubbed(dissipated_.begin(), dissipated_.end());
  list(archive, "dissipated", rubbed, [](Archive& a, auto& pair) {
    for (int& side : pair.first) whole(a, "side", side);
    a.field("dissipated", pair.second);
  });
  dissipated_ = {rubbed.begin(), rubbed.end()};
  std::vector<std::pair<std::array<int, 4>, TakenBack>> taken(taken_back_.begin(),
                                                              taken_back_.end());
  list(archive, "taken_back", taken, [](Archive& a, auto& pair) {
    for (int& side : pair.first) whole(a, "side", side);
    pair.second.state(a);
  });
  taken_back_ = {taken.begin(), taken.end()};
  whole(archive, "closings", closings_);
  whole(archive, "open", open_);
  for (double* value : {&begin_, &end_, &impulse_, &peak_}) archive.field("value", *value);
}

}  // namespace abut
