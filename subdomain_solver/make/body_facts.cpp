#include "subdomain_solver/make/body_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/stable_step.hpp"
#include "subdomain_solver/make/material.hpp"
#include "subdomain_solver/make/material_doubt.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/read_body.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

namespace {

/// Operations of the eigenvalues of all cells, about, in a second: the explicit limit of an
/// implicit body is worth no more.
constexpr double most_work = 1.0e8;

double work_of(const Mesh& mesh) {
  double work = 0.0;
  for (const CellBlock& cells : mesh.blocks)
    work += cells.count() * std::pow(cells.element->nodes * mesh.dim, 3);
  return work;
}

void add_to_box(const std::vector<double>& points, std::size_t dim, BodyFacts& facts) {
  constexpr double far = std::numeric_limits<double>::infinity();
  facts.low.resize(dim, far);
  facts.high.resize(dim, -far);
  for (std::size_t k = 0; k < points.size(); ++k) {
    facts.low[k % dim] = std::min(facts.low[k % dim], points[k]);
    facts.high[k % dim] = std::max(facts.high[k % dim], points[k]);
  }
}

/// Supports and layers without mass left out: a limit for people.
double limit_of(const FeModelSpec& fe, Mesh mesh, const BodySpec& spec, const Place& place) {
  const bool steps = spec.integrates(SchemeKind::implicit_steps);
  if (!steps || work_of(mesh) > most_work) return 0.0;
  FeOptions options;
  options.plane = fe.plane;
  options.formulation = fe.formulation;
  options.thickness = fe.thickness;
  options.hourglass = fe.hourglass;
  options.area = fe.area();
  FeModel model(std::move(mesh), make_material(*spec.material, place, fe.dimension), options);
  const double limit = stable_step(model);
  return std::isfinite(limit) ? limit : 0.0;
}

std::optional<MaterialDoubt> doubt_of(const DensityAndStiffness& numbers, const Place& place) {
  const UnitsRead& read = place.document.units_read();
  const bool known = place.document.declares_units() || !read.with.empty();
  return material_doubt(numbers, place.document.units(), known);
}

void add_material(const BodySpec& spec, const Place& place, int dimension, bool deforms,
                  BodyFacts& facts) {
  if (!spec.material) return;
  const std::unique_ptr<const Material> law = make_material(*spec.material, place, dimension);
  const Moduli moduli = law->moduli();
  const double stiffness = dimension == 1 ? moduli.youngs() : moduli.p_wave();
  if (deforms) facts.wave_speed = std::sqrt(stiffness / law->density());
  const std::optional<MaterialDoubt> doubt = doubt_of({law->density(), moduli.youngs()}, place);
  if (!doubt) return;
  const auto name = [](const auto& material) { return std::string(material.name); };
  facts.material_key = "material." + std::visit(name, *spec.material);
  facts.material_doubt = doubt->what;
  facts.material_remedy = doubt->remedy;
}

/// Of every kind of body that has a mesh, or is two bars.
struct Finder {
  const BodySpec& spec;
  const Place& place;
  BodyFacts& facts;

  void operator()(const RigidWallSpec&) const {}
  void operator()(const BarPairSpec&) const {
    facts.size_key = "model.bar_pair";
    add_material(spec, place, 1, true, facts);
    for (const BarProperties& bar : pair_properties(spec))
      add_to_box({bar.position, bar.position + bar.length}, 1, facts);
  }
  void operator()(const FeModelSpec& fe) const {
    Mesh mesh = shape(fe, FeModelSpec::name, true);
    facts.explicit_limit = spec.is_bar() ? Bar(fe_bar_properties(spec)).stable_step()
                                         : limit_of(fe, std::move(mesh), spec, place);
  }
  void operator()(const ModalModelSpec& modal) const { shape(modal, ModalModelSpec::name, true); }
  void operator()(const RigidModelSpec& rigid) const { shape(rigid, RigidModelSpec::name, false); }
  void operator()(const RigidToolSpec& tool) const { shape(tool, RigidToolSpec::name, false); }

  Mesh shape(const SolidShapeSpec& model, std::string_view name, bool deforms) const {
    const std::string key = fmt::format("model.{}", name);
    Mesh mesh = make_mesh(model, spec.initial.position, place, key);
    add_to_box(mesh.points, index(mesh.dim), facts);
    facts.size_key = key + ".mesh";
    // Bars are exact at any speed, and often have waves of speed 1.
    for (const double v : spec.initial.velocity)
      if (mesh.dim > 1) facts.speed = std::hypot(facts.speed, v);
    add_material(spec, place, model.dimension, deforms, facts);
    return mesh;
  }
};

}  // namespace

BodyFacts body_facts(const Document& document, const std::string& path,
                     const BodyContext& context) {
  const BodySpec spec = placed_body(document, path, context);
  const Place place{document, path};
  BodyFacts facts;
  std::visit(Finder{spec, place, facts}, spec.model);
  if (spec.integrator) {
    const auto name = [](const auto& scheme) { return std::string(scheme.name); };
    facts.step_key = fmt::format("integrator.{}.step", std::visit(name, *spec.integrator));
  }
  return facts;
}

std::string doubts_first(const DensityAndStiffness& numbers, const Place& place) {
  const std::optional<MaterialDoubt> doubt = doubt_of(numbers, place);
  if (!doubt) return {};
  std::string words = fmt::format("The material's {}. {} Or: ", doubt->what, doubt->remedy);
  // These are in SI whatever the scene's system is, whose symbols errors have in place of those.
  for (const auto& [symbol, name] :
       {std::pair{"kg/m^3", "kilograms per m^3"}, {" Pa ", " pascal "}})
    for (std::size_t at; (at = words.find(symbol)) != std::string::npos;)
      words.replace(at, std::string_view(symbol).size(), name);
  return words;
}

}  // namespace abut
