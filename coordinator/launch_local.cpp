#include "coordinator/launch_local.hpp"

#include <array>
#include <string>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/yaml_fields.hpp"
#include "coordinator/record/recorded_bodies.hpp"
#include "subdomain_solver/body_spec.hpp"

namespace abut {
namespace {

std::string path_of(const std::string& body) { return "bodies." + body; }

/// Reference position [m] and outward normal of a port, as the body itself describes it.
struct Place {
  double position = 0.0, normal = 0.0;
  std::string body;  // as tables name it
};

Place place_of(const PortName& name, const Document& document) {
  const std::unique_ptr<Subdomain> body = make_body(document, path_of(name.body));
  const std::vector<const Description*> bodies{&body->describe()};
  const std::vector<Port>& ports = bodies[0]->ports;
  for (std::size_t p = 0; p < ports.size(); ++p) {
    if (ports[p].name != name.port) continue;
    const int recorded = recorded_body_of(bodies, 0, static_cast<int>(p));
    return {ports[p].geometry.points.at(0), ports[p].geometry.normals.at(0),
            recorded_bodies(bodies)[static_cast<std::size_t>(recorded)].name};
  }
  throw InputError("names a port that " + name.body + " does not have",
                   document.where("interfaces"), "Name one of the body's ports.");
}

BarData bar_data(const PortName& name, const Place& place, const Document& document) {
  const std::optional<BarProperties> bar =
      bar_properties(read<BodySpec>(document, path_of(name.body)), name.port);
  BarData data;
  data.name = place.body;
  data.normal = place.normal;
  data.wall = !bar;
  if (!bar) return data;
  data.youngs_modulus = bar->youngs_modulus;
  data.density = bar->density;
  data.area = bar->area;
  data.length = bar->length;
  data.velocity = bar->velocity;
  data.free = !bar->fixed[0] && !bar->fixed[1];
  data.body_force = bar->body_force;
  return data;
}

}  // namespace

std::vector<std::unique_ptr<Subdomain>> launch_local(const Scene& scene, const Document& document,
                                                     const std::atomic<bool>* interrupted) {
  std::vector<std::unique_ptr<Subdomain>> bodies;
  for (const auto& [name, entry] : scene.bodies) {
    bodies.push_back(make_body(document, path_of(name), [interrupted] {
      if (interrupted != nullptr && interrupted->load())
        throw RunError("interrupted while a body was advancing", "", "start the run again");
    }));
  }
  return bodies;
}

void validate_body_specs(const Scene& scene, const Document& document) {
  for (const auto& [name, entry] : scene.bodies) make_body(document, path_of(name));
}

std::optional<ClosedForm> make_closed_form(const Scene& scene, const Document& document) {
  if (!scene.meta.closed_form) return std::nullopt;
  const std::string& name = std::get<BarImpactForm>(*scene.meta.closed_form).interface;
  for (const auto& [interface_name, interface] : scene.interfaces) {
    if (interface_name != name) continue;
    const std::array<PortName, 2> sides{split_port(interface.sides[0]),
                                        split_port(interface.sides[1])};
    const std::array<Place, 2> places{place_of(sides[0], document), place_of(sides[1], document)};
    const std::array<BarData, 2> bars{bar_data(sides[0], places[0], document),
                                      bar_data(sides[1], places[1], document)};
    const double gap = places[0].normal * (places[1].position - places[0].position);
    try {
      return ClosedForm{
          name, BarImpact(bars, gap, scene.time.begin), {places[0].body, places[1].body}};
    } catch (const InputError& error) {
      throw InputError(error.what_is_wrong, document.where("meta.closed_form"), error.remedy);
    }
  }
  ABUT_ASSERT(!"validate() has checked that the interface exists");
  return std::nullopt;
}

void document_body_keys(Reference& reference) { reference.add<BodySpec>("bodies.<name>"); }

void resolve_body_keys(const Scene& scene, const Document& document, ResolvedYaml& resolved) {
  for (const auto& [name, entry] : scene.bodies)
    resolved.add(path_of(name), read<BodySpec>(document, path_of(name)));
}

}  // namespace abut
