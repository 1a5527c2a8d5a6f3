#include "sdk/served/parts.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "abut.h"
#include "base/index.hpp"
#include "sdk/served/surfaces.hpp"

void abut_point(abut_body* body, const char* name, double position, double normal) {
  abut::Port port;
  port.name = name;
  port.geometry.points = {position};
  port.geometry.normals = {normal};
  body->parts->ports.push_back(port);
}

void abut_surface(abut_body* body, const char* name, const double* points, int n, const int* facets,
                  int m, int corners) {
  abut::Port port;
  port.name = name;
  abut::PortGeometry& surface = port.geometry;
  surface.dim = body->dim;
  surface.points.assign(points, points + abut::index(n) * abut::index(body->dim));
  surface.offsets.push_back(0);
  for (int f = 0; f < m; ++f) {
    for (int c = 0; c < corners; ++c)
      if (facets[f * corners + c] != -1) surface.facets.push_back(facets[f * corners + c]);
    surface.offsets.push_back(static_cast<int>(surface.facets.size()));
  }
  try {
    abut::complete_surface(surface);
  } catch (const abut::InputError& error) {  // on its way it would meet a user's program in C
    body->parts->refuse(error.what_is_wrong, fmt::format("surface() of port {}", name),
                        error.remedy);
  }
  body->parts->ports.push_back(std::move(port));
}

void abut_resolution(abut_body* body, double spacing, double transit) {
  if (body->parts->ports.empty()) {
    body->parts->refuse("comes before any port", "abut_resolution()", "Name the port first.");
    return;
  }
  abut::PortGeometry& surface = body->parts->ports.back().geometry;
  if (spacing > 0.0) surface.spacing = spacing;
  surface.transit = transit;
}

void abut_state(abut_body* body, const char* name, double* values, size_t count) {
  body->parts->states.push_back({name, values, count});
}

void abut_grid(abut_body* body, const double* points, int n) {
  abut::Grid& grid = body->parts->grid;
  grid.points =
      abut::in_space(std::span(points, abut::index(n) * abut::index(body->dim)), body->dim);
  grid.offsets.assign(1, 0);
}

void abut_cells(abut_body* body, int kind, const int* cells, int m, int nodes) {
  abut::Grid& grid = body->parts->grid;
  if (grid.points.empty()) {
    body->parts->refuse("come before their points", "abut_cells()", "Call abut_grid() first.");
    return;
  }
  for (int cell = 0; cell < m; ++cell) {
    grid.types.push_back(kind);
    grid.connectivity.insert(grid.connectivity.end(),
                             cells + abut::index(cell) * abut::index(nodes),
                             cells + abut::index(cell + 1) * abut::index(nodes));
    grid.offsets.push_back(static_cast<int>(grid.connectivity.size()));
  }
}

void abut_field(abut_body* body, const char* name, int on_cells, int components) {
  body->parts->fields.push_back(
      {name, on_cells != 0 ? abut::FieldPlace::cells : abut::FieldPlace::nodes, components});
}
