// Requests of a hostile coordinator, in a valid session, to a body of ours: the first part of an
// input is the Configured that describes the body, each other one a request.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/archive.hpp"
#include "base/assert.hpp"
#include "messaging/serve.hpp"
#include "tests/fuzz/hostile_input.hpp"
#include "tests/fuzz/hostile_message.hpp"

namespace {

using namespace abut;

/// Described by somebody else; reads all that it is given, and can do nothing.
class PaperBody : public Subdomain, private PassiveForm {
 public:
  explicit PaperBody(Description description) : description_(std::move(description)) {}

  const Description& describe() const override { return description_; }
  void meet(const Meeting&) override {}
  void save() override {}
  void restore() override {}
  void start(const Advance&) override {}
  Outcome finish(Response&) override { return Failed{}; }
  PortKernel probe(const Probing&) override { throw RunError("is paper", "", ""); }
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte> bytes) override {
    Archive archive = Archive::reader(bytes, Archive::Form::named);
    std::vector<double> values;
    archive.field("values", values);
    archive.finish();
  }
  std::uint64_t state_hash() override { return 0; }
  PassiveForm* passive() override { return description_.can.passive ? this : nullptr; }

 private:
  double enter() override { return 0.0; }
  Outcome leave(double, double&) override { return Failed{}; }
  void start(const PassiveStep&) override {}
  Outcome finish(PassiveReply&) override { return Failed{}; }
  double damp(double) override { return 0.0; }

  Description description_;
};

/// Carries one frame in, and looks at what comes out.
class OneFrame : public Channel {
 public:
  using Channel::send;
  bool send(Bytes frame) override {
    ABUT_ASSERT(open_frame(frame));
    return true;
  }
  std::optional<Bytes> receive(Milliseconds) override { return std::exchange(next_, std::nullopt); }
  void put(Bytes frame) { next_ = frame; }

 private:
  std::optional<Bytes> next_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input rest = fuzz::input_of(data, size);
  std::optional<Description> description = fuzz::described(fuzz::take_part(rest));
  if (!description) return 0;
  const MakeBody make = [&description](const Specification&, const ProgressHook&) {
    return std::unique_ptr<Subdomain>(std::make_unique<PaperBody>(*description));
  };
  OneFrame channel;
  AlwaysAlive coordinator;
  Limits limits;
  limits.frame_bytes = 1 << 20;
  Server server("body", make, channel, coordinator, limits, Deadlines{});
  Frame frame;
  v1::Request configure;
  configure.mutable_configure();
  std::string text = configure.SerializeAsString();
  std::uint64_t number = 0;
  const auto ask = [&](Bytes payload) {
    channel.put(fuzz::seal<v1::Request>(frame, payload, ++number, server.session()));
    return server.step(Milliseconds(0));
  };
  fuzz::read_or_refuse([&] {
    bool more = ask(std::as_bytes(std::span<const char>(text)));
    while (more && !rest.empty()) more = ask(fuzz::take_part(rest));
  });
  return 0;
}
