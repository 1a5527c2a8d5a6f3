#include "coordinator/record/run_facts.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "base/unit_words.hpp"
#include "coordinator/record/recorded_bodies.hpp"

namespace abut {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json bodies_json(const RunStart& start, const std::map<std::string, std::string>& units) {
  Json array = Json::array();
  for (const Description* body : start.bodies) {
    Json entry = {{"name", body->name},
                  {"model", quantities_in(units, body->model)},
                  {"dofs", body->dofs},
                  {"mass", json_number(body->mass)},
                  {"step", json_number(body->step)}};
    if (std::isinf(body->mass)) entry["immovable"] = true;
    if (!body->frequencies.empty()) entry["frequencies_hz"] = Json::array();
    for (const double hertz : body->frequencies)
      entry["frequencies_hz"].push_back(json_number(hertz));
    if (!body->members.empty()) entry["members"] = Json::array();
    for (const Member& member : body->members)
      entry["members"].push_back({{"name", member.name}, {"mass", json_number(member.mass)}});
    array.push_back(entry);
  }
  return array;
}

Json ports_json(const RunStart& start) {
  Json object = Json::object();
  const std::vector<RecordedBody> recorded = recorded_bodies(start.bodies);
  for (std::size_t b = 0; b < start.bodies.size(); ++b) {
    const Description& body = *start.bodies[b];
    for (std::size_t p = 0; p < body.ports.size(); ++p) {
      const PortGeometry& geometry = body.ports[p].geometry;
      if (geometry.dim != 1 || geometry.count() != 1) continue;
      const int on = recorded_body_of(start.bodies, static_cast<int>(b), static_cast<int>(p));
      object[body.name + "." + body.ports[p].name] = {{"position", json_number(geometry.points[0])},
                                                      {"normal", json_number(geometry.normals[0])},
                                                      {"body", recorded[on].name}};
    }
  }
  return object;
}

Json interfaces_json(const RunStart& start) {
  Json object = Json::object();
  for (const InterfaceInfo& info : start.interfaces) {
    Json sides = Json::array();
    for (const int side : {0, 1}) {
      if (info.many) continue;
      const Description& body = *start.bodies[info.body[side]];
      sides.push_back(body.name + "." + body.ports[info.port[side]].name);
    }
    object[info.name] = {{"sides", sides}, {"tied", info.tied}};
  }
  return object;
}

}  // namespace abut
