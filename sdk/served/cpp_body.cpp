// abut.hpp upon abut.h: a Body's functions as those of an abut_body.
#include "abut.hpp"

#include <algorithm>
#include <cstddef>

namespace abut {
inline namespace user {

Values Body::save() {
  Values all;
  for (const State& part : state) all.insert(all.end(), part.begin(), part.begin() + part.count());
  return all;
}

void Body::restore(const Values& saved) {
  auto from = saved.begin();
  for (const State& part : state) {
    const auto end = from + static_cast<std::ptrdiff_t>(part.count());
    std::copy(from, end, part.begin());
    from = end;
  }
}

Values Body::kernel(int, int, const Values&, double, int) { return {}; }

namespace {

/// A Body, and what its arrays are.
struct Bound {
  std::unique_ptr<Body> body;
  std::vector<std::size_t> widths;  // values of the ports
  std::size_t values = 0;           // of all of them
  Values saved;                     // between the question for its size and its copy
  std::string why;                  // a step could not be made
};

Bound& bound_to(void* self) { return *static_cast<Bound*>(self); }

/// What a body has answered, as many numbers as belong there; false: it answers nothing.
bool put(const Values& from, std::size_t count, double* to, const std::string& what) {
  if (from.empty()) return false;
  if (from.size() != count)
    throw std::length_error(what + " has " + std::to_string(from.size()) + " numbers, not " +
                            std::to_string(count));
  std::copy(from.begin(), from.end(), to);
  return true;
}

/// Motion of the ports: as the body says, or the state of this name. False: there is none.
bool put_motion(const Bound& bound, const Values& told, const char* name, double* to) {
  if (put(told, bound.values, to, name)) return true;
  for (const State& part : bound.body->state)
    if (part.name == name)
      return put(Values(part.begin(), part.begin() + part.count()), bound.values, to, name);
  return false;
}

const char* make_step(void* self, double dt, const double* force) {
  Bound& bound = bound_to(self);
  try {
    bound.body->step(dt, Values(force, force + bound.values));
  } catch (const NotConverged& error) {
    bound.why = error.what();
    return bound.why.c_str();
  }
  return nullptr;
}

void tell_displacement(void* self, double* u) {
  const Bound& bound = bound_to(self);
  if (!put_motion(bound, bound.body->displacement(), "u", u))
    throw std::logic_error("the body has neither a state u nor its own displacement()");
}

void tell_velocity(void* self, double* v) {
  const Bound& bound = bound_to(self);
  if (!put_motion(bound, bound.body->velocity(), "v", v) && !bound.body->quasi_static)
    throw std::logic_error("the body has neither a state v nor its own velocity()");
}

std::size_t save_state(void* self, double* to) {
  Bound& bound = bound_to(self);
  if (to == nullptr) bound.saved = bound.body->save();
  if (to != nullptr) std::copy(bound.saved.begin(), bound.saved.end(), to);
  return bound.saved.size();
}

int tell_kernel(void* self, int port, int patterns, const double* force, double step, int count,
                double* displacement) {
  const Bound& bound = bound_to(self);
  const std::size_t size =
      static_cast<std::size_t>(patterns) * bound.widths[static_cast<std::size_t>(port)];
  const Values told = bound.body->kernel(port, patterns, Values(force, force + size), step, count);
  return put(told, size * static_cast<std::size_t>(count), displacement, "kernel()") ? 0 : 1;
}

void tell_field(void* self, int field, double* values) {
  const Bound& bound = bound_to(self);
  const Fields nodes = bound.body->node_fields(), cells = bound.body->cell_fields();
  const auto at = static_cast<std::size_t>(field);
  const Values& from = at < nodes.size() ? nodes[at].second : cells[at - nodes.size()].second;
  std::copy(from.begin(), from.end(), values);
}

void bind_functions(abut_body& to) {
  to.step = make_step;
  to.displacement = tell_displacement;
  to.velocity = tell_velocity;
  to.work = [](void* self, double* joules) {
    put(bound_to(self).body->work(), bound_to(self).widths.size(), joules, "work()");
  };
  to.energy = [](void* self, abut_energy* energy) { *energy = bound_to(self).body->energy(); };
  to.momentum = [](void* self, double* momentum) {
    Body& body = *bound_to(self).body;
    put(body.momentum(), static_cast<std::size_t>(body.dim), momentum, "momentum()");
  };
  to.speed_bound = [](void* self) { return bound_to(self).body->speed_bound(); };
  to.acceleration_bound = [](void* self) { return bound_to(self).body->acceleration_bound(); };
  to.save = save_state;
  to.restore = [](void* self, const double* from, std::size_t count) {
    bound_to(self).body->restore(Values(from, from + count));
  };
  to.rest = [](void* self) { bound_to(self).body->rest(); };
  to.kernel = tell_kernel;
  to.field = tell_field;
  to.release = [](void* self) { delete static_cast<Bound*>(self); };
}

void name_ports(Bound& bound, abut_body& to) {
  for (const Surface& port : bound.body->surface()) {
    bound.widths.push_back(port.points.size());
    bound.values += port.points.size();
    if (port.facets.empty() && to.dim == 1) {
      abut_point(&to, port.name.c_str(), port.points.at(0), port.normal);
      abut_resolution(&to, port.spacing, port.transit);
      continue;
    }
    constexpr std::size_t corners = 4;
    std::vector<int> facets;
    for (const std::vector<int>& facet : port.facets) {
      if (facet.size() > corners)
        throw std::length_error("a facet of surface() has too many points");
      for (std::size_t c = 0; c < corners; ++c) facets.push_back(c < facet.size() ? facet[c] : -1);
    }
    abut_surface(&to, port.name.c_str(), port.points.data(),
                 static_cast<int>(port.points.size()) / to.dim, facets.data(),
                 static_cast<int>(facets.size() / corners), static_cast<int>(corners));
    abut_resolution(&to, port.spacing, port.transit);
  }
}

void name_pictures(Body& body, abut_body& to) {
  const Grid grid = body.grid();
  const std::size_t nodes = grid.points.size() / static_cast<std::size_t>(body.dim);
  if (nodes > 0) abut_grid(&to, grid.points.data(), static_cast<int>(nodes));
  for (const auto& [kind, cell] : grid.cells)
    abut_cells(&to, kind, cell.data(), 1, static_cast<int>(cell.size()));
  const auto name = [&to](const Fields& fields, bool on_cells, std::size_t places) {
    for (const auto& [called, values] : fields)
      abut_field(&to, called.c_str(), on_cells ? 1 : 0,
                 static_cast<int>(values.size() / std::max<std::size_t>(1, places)));
  };
  std::size_t points = nodes;
  if (nodes == 0)
    for (const Surface& port : body.surface())
      points += port.points.size() / static_cast<std::size_t>(body.dim);
  name(body.node_fields(), false, points);
  name(body.cell_fields(), true, grid.cells.size());
}

void make_body(abut_keys* keys, abut_body* to, void* with) {
  auto bound = std::make_unique<Bound>();
  try {
    bound->body = (*static_cast<const Make*>(with))(Keys(keys));
  } catch (const Keys::Refused&) {
    return;  // has been noted, and is told
  }
  Body& body = *bound->body;
  to->dim = body.dim;
  to->mass = body.mass;
  to->substep = body.substep;
  to->stable_step = body.stable_step;
  to->surface_mass = body.surface_mass;
  to->conserves = body.conserves ? 1 : 0;
  to->linear = body.linear ? 1 : 0;
  to->quasi_static = body.quasi_static ? 1 : 0;
  to->model = body.model.empty() ? nullptr : body.model.c_str();
  name_ports(*bound, *to);
  name_pictures(body, *to);
  bind_functions(*to);
  to->self = bound.release();
}

}  // namespace

int serve(int argc, char** argv, const Make& make) {
  Make own = make;
  return abut_serve(argc, argv, make_body, &own);
}

}  // namespace user
}  // namespace abut
