// Goal: once buffers have grown, what an exchange writes and reads allocates nothing.
// Oracle: the count of calls of operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <utility>

#include "base/index.hpp"
#include "messaging/frame.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// The sanitizers' own would not fit the operator delete below; sockets ask for it.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(size);
}
// GCC sees the free() of what one of the above has taken, where it puts them in line, and not the
// malloc() there.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace abut::allocations_test {
namespace {

Waveform wave(int width) {
  Waveform made(width);
  for (int i = 0; i <= 50; ++i) made.time.push_back(0.02 * i);
  made.time.back() = 1.0;
  for (std::vector<double>* field : {&made.u, &made.v, &made.a, &made.f})
    field->assign(made.time.size() * index(width), 0.5);
  return made;
}

TEST(Allocations, AWindowThatIsWrittenAndReadTakesNoMemory) {
  Description body;
  body.dim = 2;
  body.ports.resize(1);
  body.ports[0].geometry.dim = 2;
  body.ports[0].geometry.points.assign(40, 0.0);
  const Partners met{{SurfaceSize{30, 2}}};
  Advance advance;
  advance.window = {3, 0.0, 1.0};
  advance.boundary.resize(1);
  advance.boundary[0].forces = {wave(40)};
  advance.boundary[0].obstacles = {Obstacle{wave(60), {}}};
  advance.want.resize(1);
  Response response;
  response.ports.resize(1);
  response.ports[0].trace = wave(40);
  response.ports[0].reactions = {Reaction{wave(60)}};
  response.records.resize(1);
  response.records[0].momentum = {1.0, 2.0};

  Frame request, reply;
  v1::Request asked;
  v1::Reply answered;
  Advance got_advance;
  Response got_response;
  Waveform spare;
  long before = 0;
  for (int window = 0; window < 10; ++window) {
    if (window == 3) before = allocations;
    Bytes bulk;
    WireWriter& there = request.open();
    encode(advance, there);
    there.close(v1::Request::kAdvanceFieldNumber, 0);
    request.seal();
    ASSERT_TRUE(parse_into(asked, *open_frame(request.bytes()), bulk));
    decode(bulk, body, met, got_advance);
    WireWriter& back = reply.open();
    encode(response, got_advance, back);
    back.close(v1::Reply::kAdvancedFieldNumber, 0);
    reply.seal();
    ASSERT_TRUE(parse_into(answered, *open_frame(reply.bytes()), bulk));
    decode(bulk, body, advance, got_response);
    // Free flight between windows in contact: what is absent keeps its memory.
    std::swap(advance.boundary[0].forces[0], spare);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(got_response.ports[0].trace.u, response.ports[0].trace.u);
}

TEST(Allocations, APassiveStepThatIsWrittenAndReadTakesNoMemory) {
  Description body;
  body.dim = 2;
  body.ports.resize(2);
  PassiveStep step;
  step.end = 1.0;
  PassiveReply reply;
  for (Port& port : body.ports) {
    port.geometry.dim = 2;
    port.geometry.points.assign(40, 0.0);
    step.impulses.emplace_back(40, 0.5);
    step.pressed.push_back({1, 2, 5, 19});
    reply.ports.push_back({std::vector<double>(40, 0.5), std::vector<double>(40, 0.25)});
  }
  reply.compliance.assign(16 * 16, 0.5);
  reply.record.momentum = {1.0, 2.0};

  Frame request, answer;
  v1::Request asked;
  v1::Reply answered;
  PassiveStep got_step;
  PassiveReply got_reply;
  long before = 0;
  for (int k = 0; k < 10; ++k) {
    if (k == 3) before = allocations;
    Bytes bulk;
    WireWriter& there = request.open();
    encode(step, there);
    there.close(v1::Request::kPassiveStepFieldNumber, 0);
    request.seal();
    ASSERT_TRUE(parse_into(asked, *open_frame(request.bytes()), bulk));
    decode(bulk, body, got_step);
    WireWriter& back = answer.open();
    encode(reply, back);
    back.close(v1::Reply::kPassiveSteppedFieldNumber, 0);
    answer.seal();
    ASSERT_TRUE(parse_into(answered, *open_frame(answer.bytes()), bulk));
    decode(bulk, body, got_step, got_reply);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(got_reply.compliance, reply.compliance);
}

}  // namespace
}  // namespace abut::allocations_test
