// Goal: ParaView opens fields.pvsm and shows all bodies deformed, coloured, with a scale, in sight.
// Oracle: what ParaView 5.11 asks of a state file, each part that is named being there; the view's
// own geometry.
#include "coordinator/record/paraview_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <pugixml.hpp>

namespace abut::test_paraview_state {
namespace {

const FieldInfo stress{"nodal_von_mises", FieldPlace::nodes, 1};

ParaviewView view_of(std::optional<FieldInfo> colour, double depth) {
  return {{-1.0, 0.0, 0.0}, {3.0, 2.0, depth}, std::move(colour), 5.0e6};
}

pugi::xml_node state_of(pugi::xml_document& document, const ParaviewView& view) {
  const std::string text = paraview_state("/runs/a & \"b\"/fields.pvd", view);
  EXPECT_TRUE(document.load_string(text.c_str()));
  return document.child("ParaView").child("ServerManagerState");
}

pugi::xml_node part(pugi::xml_node state, const char* type) {
  return state.find_child_by_attribute("Proxy", "type", type);
}

std::vector<std::string> words(pugi::xml_node of, const char* name) {
  std::vector<std::string> found;
  const pugi::xml_node property = of.find_child_by_attribute("Property", "name", name);
  for (pugi::xml_node element : property.children("Element"))
    found.emplace_back(element.attribute("value").value());
  EXPECT_EQ(found.size(), property.attribute("number_of_elements").as_uint()) << name;
  return found;
}

std::vector<double> numbers(pugi::xml_node of, const char* name) {
  std::vector<double> found;
  for (const std::string& word : words(of, name)) found.push_back(std::stod(word));
  return found;
}

TEST(ParaviewState, NamesOnlyPartsThatAreThere) {
  for (const std::optional<FieldInfo>& colour :
       {std::optional(stress), std::optional<FieldInfo>()}) {
    pugi::xml_document document;
    const pugi::xml_node state = state_of(document, view_of(colour, 1.0));
    std::set<std::string> there, named;
    for (pugi::xml_node each : state.children("Proxy"))
      EXPECT_TRUE(there.insert(each.attribute("id").value()).second) << "each once";
    for (const pugi::xpath_node each : state.select_nodes(".//Property/Proxy/@value"))
      named.insert(each.attribute().value());
    for (const pugi::xpath_node each : state.select_nodes("ProxyCollection/Item/@id"))
      named.insert(each.attribute().value());
    EXPECT_EQ(named, there);
    EXPECT_EQ(there.size(), colour ? 6u : 4u);
  }
}

TEST(ParaviewState, OpensTheListAndDeformsBodies) {
  pugi::xml_document document;
  const pugi::xml_node state = state_of(document, view_of(stress, 1.0));
  EXPECT_EQ(words(part(state, "PVDReader"), "FileName"),
            std::vector<std::string>{"/runs/a & \"b\"/fields.pvd"});
  EXPECT_EQ(words(part(state, "WarpVector"), "SelectInputVectors").back(), "displacement");
}

TEST(ParaviewState, ColoursGoFromNothingToTheLargestValue) {
  pugi::xml_document document;
  const pugi::xml_node state = state_of(document, view_of(stress, 1.0));
  const std::vector<double> points = numbers(part(state, "PVLookupTable"), "RGBPoints");
  ASSERT_EQ(points.size(), 24u);
  EXPECT_EQ(points.front(), 0.0);
  EXPECT_EQ(points[20], 5.0e6);
  const std::vector<std::string> at_nodes{"", "", "", "0", "nodal_von_mises"};
  EXPECT_EQ(words(part(state, "UnstructuredGridRepresentation"), "ColorArrayName"), at_nodes);
}

TEST(ParaviewState, TheCameraSeesTheWholeBox) {
  for (const double depth : {0.0, 1.0}) {
    pugi::xml_document document;
    const pugi::xml_node view = part(state_of(document, view_of(stress, depth)), "RenderView");
    const std::vector<double> eye = numbers(view, "CameraPosition");
    const std::vector<double> middle = numbers(view, "CameraFocalPoint");
    EXPECT_EQ(middle, (std::vector<double>{1.0, 1.0, 0.5 * depth}));
    const double far = std::hypot(eye[0] - middle[0], eye[1] - middle[1], eye[2] - middle[2]);
    const double radius = 0.5 * std::hypot(4.0, 2.0, depth);
    // ParaView's camera opens by 30 degrees: a ball fits from radius / sin(15 degrees) on
    EXPECT_GT(far, 3.86 * radius);
    EXPECT_LT(far, 5.0 * radius);
    EXPECT_EQ(eye[0] == middle[0], depth <= 0.0) << "what is flat is seen from the front";
  }
}

TEST(ParaviewState, StressColoursBodiesAndElseVelocity) {
  const FieldInfo velocity{"velocity", FieldPlace::nodes, 3};
  const FieldInfo cells{"von_mises", FieldPlace::cells, 1};
  const std::vector<FieldInfo> solid{velocity, cells, stress}, bar{velocity, cells},
      rigid{velocity};
  EXPECT_EQ(colour_among(solid)->name, "nodal_von_mises");
  EXPECT_EQ(colour_among(bar)->name, "von_mises");
  EXPECT_EQ(colour_among(rigid)->name, "velocity");
  EXPECT_FALSE(colour_among({}).has_value());
}

TEST(ParaviewState, MagnitudesAreOfWholeVectors) {
  const std::vector<double> values{3.0, 4.0, 0.0, 0.0, -4.9, 0.0};
  EXPECT_EQ(largest_magnitude(values, 3), 5.0);
  EXPECT_EQ(largest_magnitude(values, 1), 4.9);
  EXPECT_EQ(largest_magnitude({}, 1), 0.0);
}

}  // namespace
}  // namespace abut::test_paraview_state
