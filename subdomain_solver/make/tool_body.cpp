#include <algorithm>
#include <functional>
#include <optional>

#include "subdomain_solver/make/adjust.hpp"
#include "subdomain_solver/make/expression.hpp"
#include "subdomain_solver/make/makers.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/scheme.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/rigid/rigid_tool.hpp"

namespace abut {

namespace {

/// A formula of time alone.
std::function<double(double)> of_time(const std::string& text, const std::string& where) {
  return [formula = expression(text, where)](double time) {
    return formula({0.0, 0.0, 0.0}, time);
  };
}

Eigen::Vector3d in_space(const std::vector<double>& numbers) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < std::min<std::size_t>(3, numbers.size()); ++i)
    out(static_cast<Eigen::Index>(i)) = numbers[i];
  return out;
}

std::optional<ToolTurn> turn_of(const RigidToolSpec& tool, const std::vector<double>& origin,
                                const Place& place) {
  if (!tool.turn) return std::nullopt;
  const TurnSpec& turn = *tool.turn;
  return ToolTurn(of_time(turn.angle, place.where("model.rigid_tool.turn.angle")),
                  in_space(turn.about.empty() ? origin : turn.about),
                  turn.axis.empty() ? Eigen::Vector3d::UnitZ() : in_space(turn.axis));
}

}  // namespace

std::unique_ptr<Interior> make_tool(const BodySpec& spec, const Place& place) {
  const RigidToolSpec& tool = std::get<RigidToolSpec>(spec.model);
  std::vector<std::string> notes;
  Mesh mesh = make_mesh(tool, spec.initial.position, place, "model.rigid_tool", &notes);
  name_points(spec, place, mesh);
  const std::vector<SolidInterior::PortNodes> ports = make_ports(spec, place, mesh);
  const std::string adjusted = adjust_ports(spec, place, ports, {}, mesh);
  std::vector<RigidTool::Way> way;
  for (int i = 0; i < mesh.dim; ++i) {
    if (tool.way.empty()) {
      way.push_back([](double) { return 0.0; });
      continue;
    }
    const std::string key = "model.rigid_tool.way[" + std::to_string(i) + "]";
    way.push_back(of_time(tool.way[i], place.where(key)));
  }
  // A shape alone: nothing asks for its stiffness or its mass.
  const std::string words = (tool.turn          ? "rigid tool that turns"
                             : tool.way.empty() ? "rigid tool that stands"
                                                : "rigid tool on its way") +
                            on_file(tool, notes) + adjusted;
  FeOptions options;
  options.plane = tool.plane;
  auto shape = std::make_unique<FeModel>(
      std::move(mesh), std::make_unique<LinearElastic>(Moduli{1.0, 1.0}, 1.0), options);
  return std::make_unique<RigidTool>(place.name(), std::move(shape), std::move(way),
                                     turn_of(tool, spec.initial.position, place),
                                     tool.step.value_or(0.0), ports, words);
}

}  // namespace abut
