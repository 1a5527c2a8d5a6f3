#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "coordinator/launch.hpp"
#include "tests/transport/loop.hpp"

namespace abut {

/// Fake solvers in processes of their own, launched as a scene's bodies are; none may be left.
class LaunchTest : public testing::Test {
 protected:
  static constexpr std::size_t limit = 1'000'000;  // [B] of a frame
  void SetUp() override {
    scene_.network.startup_deadline = 5.0;
    scene_.network.request_deadline = 5.0;
    scene_.network.endpoint = "tcp://127.0.0.1:*";
    options_.solver = ABUT_FAKE_SOLVER;
    options_.limits.frame_bytes = limit;
    options_.deadlines.repeat = Milliseconds(200);
  }
  void TearDown() override {
    launch_.reset();
    for (const std::string& name : variables_) unsetenv(name.c_str());
    for (const std::int64_t id : ids_) {
      EXPECT_NE(kill(static_cast<pid_t>(id), 0), 0) << "process " << id << " is left behind";
    }
  }

  void add_body(const std::string& name, const std::string& manners = "") {
    BodyEntry entry;
    entry.name = name;
    scene_.bodies.emplace_back(name, entry);
    if (manners.empty()) return;
    variables_.push_back("ABUT_FAKE_" + name);
    setenv(variables_.back().c_str(), manners.c_str(), 1);
  }
  void start() {
    launch_ =
        std::make_unique<Launch>(scene_, Specification{"scene.yaml", text_, {}, ""}, options_);
    ids_ = launch_->process_ids();
    bodies_ = launch_->take_bodies();
  }
  /// What is wrong, after at most `seconds`.
  std::string error_within(double seconds, const std::function<void()>& act) {
    const TimePoint begin = std::chrono::steady_clock::now();
    std::string text = "no error";
    try {
      act();
    } catch (const RunError& error) {
      text = error.what_is_wrong + " | " + error.remedy;
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(taken.count(), seconds);
    return text;
  }
  void advance_first() {
    Response response;
    const Advance advance = request_for(0);
    EXPECT_TRUE(std::holds_alternative<Advanced>(bodies_.at(0)->advance(advance, response)));
  }
  static bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  Scene scene_;
  std::string text_ = "scene";
  LaunchOptions options_;
  std::unique_ptr<Launch> launch_;
  std::vector<std::unique_ptr<Subdomain>> bodies_;
  std::vector<std::int64_t> ids_;
  std::vector<std::string> variables_;
};

/// Both bodies at once, one rewind per window; the hashes of both at the end.
inline std::vector<std::uint64_t> play_both(Subdomain& a, Subdomain& b) {
  Response of_a, of_b;
  for (int window = 0; window < 20; ++window) {
    const Advance advance = request_for(window);
    for (int pass = 0; pass < 2; ++pass) {
      for (Subdomain* body : {&a, &b}) pass == 0 ? body->save() : body->restore();
      a.start(advance);
      b.start(advance);
      // Waiting for the second first: the reply of the other is kept meanwhile.
      EXPECT_TRUE(std::holds_alternative<Advanced>(b.finish(of_b)));
      EXPECT_TRUE(std::holds_alternative<Advanced>(a.finish(of_a)));
    }
  }
  return {a.state_hash(), b.state_hash()};
}

}  // namespace abut
