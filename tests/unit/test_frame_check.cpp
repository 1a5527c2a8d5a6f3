// Goal: what no frame holds is refused before the run, and nothing that one holds. Oracle: the
// bytes of the numbers, counted by hand; the frame that a reply becomes.
#include "coordinator/frame_check.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/reply_bytes.hpp"

namespace abut::test_frame_check {
namespace {

/// A body in space whose one port has so many points.
Description body(int points) {
  Description body;
  body.name = "left";
  body.dim = 3;
  body.step = 1.0e-7;
  Port& port = body.ports.emplace_back();
  port.geometry.dim = 3;
  port.geometry.points.resize(3 * static_cast<std::size_t>(points));
  port.geometry.normals = port.geometry.points;
  return body;
}

std::string refusal(const Description& body, std::size_t limit, const FieldSize& fields = {}) {
  const Document document = Document::from_text(
      "test", "time: {begin: 0.0, end: 1.0e-4, window: 1.0e-5}\noutput: {fields: {every: 1}}\n");
  Scene scene;
  scene.time = {0.0, 1.0e-4, 1.0e-5, {}};
  scene.interfaces.emplace_back("hit", InterfaceSpec{});
  const Description* bodies[] = {nullptr, &body};  // of one of which nothing is known
  const FieldSize sizes[] = {{}, fields};
  try {
    check_frames(scene, bodies, sizes, limit, document);
  } catch (const InputError& error) {
    return error.where + ": " + error.what_is_wrong;
  }
  return "accepted";
}

TEST(FrameCheck, CountsTheNumbersOfAReply) {
  // u, v and f of 10 points in space at 101 times; a record: a box, energies, momenta.
  EXPECT_EQ(reply_bytes(body(10), 101.0, 1.0), 8.0 * (101.0 * 3.0 * 30.0 + 6.0 + 5.0 + 3.0 + 3.0));
  Description told = body(10);
  told.columns = {"heat [J]", "wear [m]"};
  EXPECT_EQ(reply_bytes(told, 101.0, 4.0), 8.0 * (101.0 * 3.0 * 30.0 + 4.0 * 19.0));
}

TEST(FrameCheck, RefusesReplyDescriptionAndFieldsThatNoFrameHolds) {
  const double reply = reply_bytes(body(10), 101.0, 1.0);  // 72,856 bytes
  EXPECT_EQ(refusal(body(10), static_cast<std::size_t>(reply)), "accepted");
  const std::string of_window = refusal(body(10), static_cast<std::size_t>(reply) - 1);
  EXPECT_NE(of_window.find("time.window: the reply to a window of 101 times of body 'left'"),
            std::string::npos)
      << of_window;
  Description still = body(10);
  still.step = 0.0;
  EXPECT_EQ(refusal(still, 2000), "accepted");
  EXPECT_NE(refusal(still, 400).find("the description of body 'left'"), std::string::npos);
  still.fields = {{"displacement", FieldPlace::nodes, 3}, {"stress", FieldPlace::cells, 6}};
  EXPECT_EQ(refusal(still, 96'000, {2000, 1000}), "accepted");  // 8 (3 x 2000 + 6 x 1000)
  EXPECT_NE(refusal(still, 95'999, {2000, 1000}).find("output.fields: a set of fields"),
            std::string::npos);
}

}  // namespace
}  // namespace abut::test_frame_check
