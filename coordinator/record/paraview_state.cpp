#include "coordinator/record/paraview_state.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace abut {
namespace {

/// Numbers of the parts of the file, by which they name each other.
enum Part { reader = 1, deformed, colours, surfaces, scale, picture };

constexpr const char* client_and_renderer = "21";  // where ParaView keeps what is seen
constexpr const char* data_server = "1";           // where it keeps what is read

/// Red, green and blue of a scale from its low end to its high end, as on pages of runs.
constexpr std::array<std::array<double, 3>, 6> ramp{{{0.251, 0.227, 0.549},
                                                     {0.227, 0.416, 0.706},
                                                     {0.157, 0.596, 0.722},
                                                     {0.220, 0.722, 0.565},
                                                     {0.627, 0.816, 0.345},
                                                     {0.992, 0.878, 0.298}}};

pugi::xml_node add_part(pugi::xml_node to, const char* group, const char* type, Part part,
                        const char* servers) {
  pugi::xml_node node = to.append_child("Proxy");
  node.append_attribute("group") = group;
  node.append_attribute("type") = type;
  node.append_attribute("id") = static_cast<int>(part);
  node.append_attribute("servers") = servers;
  return node;
}

pugi::xml_node add_property(pugi::xml_node part, const char* name, std::size_t elements) {
  pugi::xml_node node = part.append_child("Property");
  node.append_attribute("name") = name;
  node.append_attribute("id") = fmt::format("{}.{}", part.attribute("id").value(), name).c_str();
  node.append_attribute("number_of_elements") = elements;
  return node;
}

void set_words(pugi::xml_node part, const char* name, const std::vector<std::string>& words) {
  pugi::xml_node node = add_property(part, name, words.size());
  for (std::size_t k = 0; k < words.size(); ++k) {
    pugi::xml_node element = node.append_child("Element");
    element.append_attribute("index") = k;
    element.append_attribute("value") = words[k].c_str();
  }
}

void set_numbers(pugi::xml_node part, const char* name, std::span<const double> numbers) {
  std::vector<std::string> words;
  for (const double number : numbers) words.push_back(fmt::format("{}", number));
  set_words(part, name, words);
}

void set_parts(pugi::xml_node part, const char* name, std::initializer_list<Part> others) {
  pugi::xml_node node = add_property(part, name, others.size());
  for (const Part other : others) {
    pugi::xml_node element = node.append_child("Proxy");
    element.append_attribute("value") = static_cast<int>(other);
    if (other == reader || other == deformed) element.append_attribute("output_port") = 0;
  }
}

/// An array of the data, with the number by which ParaView says where it has its values.
void set_array(pugi::xml_node part, const char* name, const FieldInfo& field) {
  set_words(part, name, {"", "", "", field.place == FieldPlace::nodes ? "0" : "1", field.name});
}

void add_colours(pugi::xml_node state, const ParaviewView& view) {
  pugi::xml_node node =
      add_part(state, "lookup_tables", "PVLookupTable", colours, client_and_renderer);
  const double largest = view.largest > 0.0 ? view.largest : 1.0;
  std::vector<double> points;
  for (std::size_t k = 0; k < ramp.size(); ++k) {
    points.push_back(largest * static_cast<double>(k) / static_cast<double>(ramp.size() - 1));
    points.insert(points.end(), ramp[k].begin(), ramp[k].end());
  }
  set_numbers(node, "RGBPoints", points);
  set_words(node, "ColorSpace", {"0"});                 // mixed in red, green and blue
  set_words(node, "AutomaticRescaleRangeMode", {"1"});  // grows while the run goes on
  set_words(node, "ScalarRangeInitialized", {"1"});
  pugi::xml_node bar = add_part(state, "representations", "ScalarBarWidgetRepresentation", scale,
                                client_and_renderer);
  set_words(bar, "Enabled", {"1"});
  set_words(bar, "Visibility", {"1"});
  set_parts(bar, "LookupTable", {colours});
  set_words(bar, "Title", {view.colour->name});
  set_words(bar, "TitleFontSize", {"12"});
  set_words(bar, "LabelFontSize", {"12"});
  set_words(bar, "ComponentTitle", {view.colour->components > 1 ? "magnitude" : ""});
}

void add_picture(pugi::xml_node state, const ParaviewView& view) {
  std::array<double, 3> centre{}, eye{}, size{};
  for (int i = 0; i < 3; ++i) {
    centre[i] = 0.5 * (view.low[i] + view.high[i]);
    size[i] = view.high[i] - view.low[i];
  }
  const double radius = std::max(0.5 * std::hypot(size[0], size[1], size[2]), 1e-300);
  const bool flat = size[2] < 1e-9 * radius;
  const std::array<double, 3> towards =
      flat ? std::array{0.0, 0.0, 1.0} : std::array{0.49, -0.80, 0.34};
  for (int i = 0; i < 3; ++i) eye[i] = centre[i] + 4.0 * radius * towards[i];
  pugi::xml_node node = add_part(state, "views", "RenderView", picture, client_and_renderer);
  if (view.colour)
    set_parts(node, "Representations", {surfaces, scale});
  else
    set_parts(node, "Representations", {surfaces});
  set_numbers(node, "CameraPosition", eye);
  set_numbers(node, "CameraFocalPoint", centre);
  set_numbers(node, "CenterOfRotation", centre);
  set_numbers(node, "CameraViewUp", flat ? std::array{0.0, 1.0, 0.0} : std::array{0.0, 0.0, 1.0});
  set_numbers(node, "CameraParallelScale", std::array{radius});
}

void add_name(pugi::xml_node state, const char* group,
              std::initializer_list<std::pair<Part, std::string>> names) {
  pugi::xml_node node = state.append_child("ProxyCollection");
  node.append_attribute("name") = group;
  for (const auto& [part, name] : names) {
    pugi::xml_node item = node.append_child("Item");
    item.append_attribute("id") = static_cast<int>(part);
    item.append_attribute("name") = name.c_str();
  }
}

}  // namespace

std::optional<FieldInfo> colour_among(std::span<const FieldInfo> fields) {
  for (const char* name : {"nodal_von_mises", "von_mises", "velocity"}) {
    const auto found = std::ranges::find(fields, name, &FieldInfo::name);
    if (found != fields.end()) return *found;
  }
  return {};
}

double largest_magnitude(std::span<const double> values, int components) {
  double largest = 0.0;
  const auto width = static_cast<std::size_t>(components);
  for (std::size_t at = 0; at + width <= values.size(); at += width) {
    double sum = 0.0;
    for (const double value : values.subspan(at, width)) sum += value * value;
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest);
}

std::string paraview_state(const std::filesystem::path& list, const ParaviewView& view) {
  pugi::xml_document document;
  pugi::xml_node state = document.append_child("ParaView").append_child("ServerManagerState");
  state.append_attribute("version") = "5.11.0";
  pugi::xml_node read = add_part(state, "sources", "PVDReader", reader, data_server);
  set_words(read, "FileName", {list.string()});
  pugi::xml_node warp = add_part(state, "filters", "WarpVector", deformed, data_server);
  set_parts(warp, "Input", {reader});
  set_array(warp, "SelectInputVectors", {"displacement", FieldPlace::nodes, 3});
  pugi::xml_node shown = add_part(state, "representations", "UnstructuredGridRepresentation",
                                  surfaces, client_and_renderer);
  set_parts(shown, "Input", {deformed});
  set_words(shown, "Visibility", {"1"});
  set_words(shown, "Representation", {"Surface"});
  set_words(shown, "LineWidth", {"6"});  // of bars
  if (view.colour) {
    set_array(shown, "ColorArrayName", *view.colour);
    set_parts(shown, "LookupTable", {colours});
    add_colours(state, view);
  }
  add_picture(state, view);
  add_name(state, "sources", {{reader, "fields"}, {deformed, "deformed"}});
  if (view.colour) {
    add_name(state, "lookup_tables", {{colours, view.colour->name + ".PVLookupTable"}});
    add_name(state, "scalar_bars", {{scale, "scale"}});
  }
  add_name(state, "representations", {{surfaces, "surfaces"}});
  add_name(state, "views", {{picture, "bodies"}});
  std::ostringstream text;
  document.save(text, " ");
  return text.str();
}

}  // namespace abut
