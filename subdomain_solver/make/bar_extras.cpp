#include "subdomain_solver/make/bar_extras.hpp"

#include "subdomain_solver/make/expression.hpp"
#include "subdomain_solver/make/fields.hpp"
#include "subdomain_solver/make/mesh.hpp"

namespace abut {

namespace {

/// Solids tell what is wrong with names and places.
Mesh mesh_of(const BodySpec& spec, const Place& place) {
  Mesh mesh =
      make_mesh(std::get<FeModelSpec>(spec.model), spec.initial.position, place, "model.fe");
  name_points(spec, place, mesh);
  return mesh;
}

int loaded_end(const BodySpec& spec, const LoadSpec& load, const std::string& key,
               const Place& place) {
  if (load.on == "left" || load.on == "right") return load.on == "left" ? 0 : 1;
  const Mesh mesh = mesh_of(spec, place);
  return named(place, key + ".on", [&] {
    (void)mesh.side(load.on);
    return -1;
  });
}

/// [N] along x.
BarLoads::OfTime force_on(int end, const LoadSpec& load, const std::string& key, const Place& place,
                          const Bar& bar) {
  const std::array<double, 3> at = {bar.place_of(bar.node_of(end)), 0.0, 0.0};
  const double area = bar.data().area;
  if (!load.traction.empty()) {
    const ScalarField traction = field_of(load.traction, 1, place.where(key + ".traction"))[0];
    return [traction, at, area](double time) { return area * traction(at, time); };
  }
  if (load.follows) {
    throw InputError("follows the body, but the ends of a bar keep their area",
                     place.where(key + ".follows"),
                     "Leave follows out: the pressure acts on the reference area.");
  }
  const ScalarField pressure = expression(load.pressure, place.where(key + ".pressure"));
  const double inward = -Bar::outward(end) * area;
  return [pressure, at, inward](double time) { return inward * pressure(at, time); };
}

std::unique_ptr<BarLoads> make_bar_loads(const BodySpec& spec, const Place& place, const Bar& bar) {
  if (spec.loads.empty()) return nullptr;
  const bool explicit_in_time = spec.integrates(SchemeKind::explicit_steps);
  std::unique_ptr<BarLoads> loads = std::make_unique<BarLoads>(bar, explicit_in_time);
  for (const auto& [name, load] : spec.loads) {
    const std::string key = "loads." + name;
    if (load.acceleration.empty()) {
      const int end = loaded_end(spec, load, key, place);
      loads->push(end, force_on(end, load, key, place, bar));
      continue;
    }
    const std::string where = place.where(key + ".acceleration");
    const ScalarField field = field_of(load.acceleration, 1, where)[0];
    loads->accelerate([field](double x, double time) { return field({x, 0.0, 0.0}, time); });
  }
  return loads;
}

std::vector<double> nodal(const std::vector<std::string>& texts, const char* key,
                          const Place& place, const Bar& bar) {
  std::vector<double> values;
  if (texts.empty()) return values;
  const ScalarField field = field_of(texts, 1, place.where(key))[0];
  for (int node = 0; node < bar.nodes(); ++node)
    values.push_back(
        start_value(field, {bar.place_of(node), 0.0, 0.0}, 1, place.where(key)));
  return values;
}

}  // namespace

void check_points(const BodySpec& spec, const Place& place) {
  if (!spec.points.empty()) (void)mesh_of(spec, place);
}

BarInterior::Extras make_extras(const BodySpec& spec, const Place& place, const Bar& bar) {
  const InitialSpec& start = spec.initial;
  return {nodal(start.displacement_field, "initial.displacement_field", place, bar),
          nodal(start.velocity_field, "initial.velocity_field", place, bar),
          make_bar_loads(spec, place, bar)};
}

}  // namespace abut
