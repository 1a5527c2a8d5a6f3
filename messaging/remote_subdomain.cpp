#include "messaging/remote_subdomain.hpp"

#include "base/index.hpp"
#include "messaging/codec.hpp"
#include "messaging/soundness.hpp"

namespace abut {

void RemoteSubdomain::start_configure(const Specification& specification) {
  v1::Configure& configure = *caller_.request().mutable_configure();
  configure.set_document(specification.document);
  configure.set_text(specification.text);
  configure.mutable_overrides()->Assign(specification.overrides.begin(),
                                        specification.overrides.end());
  configure.set_path(specification.path);
  caller_.post("configure");
}

void RemoteSubdomain::finish_configure() {
  const v1::Reply& reply = caller_.await();
  if (!reply.has_configured()) caller_.refuse_reply("not a description");
  try {
    decode(reply.configured().description(), description_);
    require_sound(description_);
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
  description_.name = caller_.body();  // a body is called what its scene calls it
}

void RemoteSubdomain::ping() {
  caller_.request().mutable_ping();
  if (!caller_.call("ping").has_pong()) caller_.refuse_reply("not a pong");
}

void RemoteSubdomain::meet(int port, const PortGeometry& partner, const ContactLaw& law) {
  encode(Meeting{port, partner, law}, *caller_.request().mutable_meet());
  carry_flags();
  if (!caller_.call("meet").has_met()) caller_.refuse_reply("not a meeting");
}

void RemoteSubdomain::yields(int port, int partner, const PortKernel& kernel) {
  encode(Yielding{port, partner, kernel}, *caller_.request().mutable_yields());
  carry_flags();
  if (!caller_.call("yields").has_yielding()) caller_.refuse_reply("not a yielding");
}

void RemoteSubdomain::save() { save_first_ = true; }

void RemoteSubdomain::restore() {
  // What is about to be saved is the present state, so there is nothing to return from.
  if (!save_first_) restore_first_ = true;
}

void RemoteSubdomain::carry_flags() {
  caller_.request().set_restore_first(restore_first_);
  caller_.request().set_save_first(save_first_);
  restore_first_ = false;
  save_first_ = false;
}

void RemoteSubdomain::start(const Advance& request) {
  asked_ = &request;
  carry_flags();
  caller_.post(request);
}

Outcome RemoteSubdomain::finish(Response& response) {
  const v1::Reply& reply = caller_.await();
  try {
    if (reply.has_advanced()) {
      decode(caller_.advanced(), description_, *asked_, response);
      require_sound(response, description_, *asked_);
      return Advanced{};
    }
    if (reply.has_failed()) {
      Failed failed;
      decode(reply.failed(), failed);
      return failed;
    }
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
  caller_.refuse_reply("not a response");
}

PortKernel RemoteSubdomain::probe(int port, std::span<const double> patterns, double step,
                                  int count) {
  return probe(port, patterns, step, count, {});
}

PortKernel RemoteSubdomain::probe(int port, std::span<const double> patterns, double step,
                                  int count, std::span<const int> seen) {
  const Probing probing{
      port, {patterns.begin(), patterns.end()}, step, count, {seen.begin(), seen.end()}};
  encode(probing, *caller_.request().mutable_probe());
  carry_flags();
  const v1::Reply& reply = caller_.call("probe");
  if (!reply.has_kernel()) caller_.refuse_reply("not a kernel");
  PortKernel result;
  try {
    decode(reply.kernel(), description_, probing, result);
    require_sound(result, description_, probing);
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
  result.step = probing.step;
  return result;
}

std::vector<std::byte> RemoteSubdomain::checkpoint() {
  caller_.request().mutable_checkpoint();
  carry_flags();
  const v1::Reply& reply = caller_.call("checkpoint");
  if (!reply.has_checkpoint()) caller_.refuse_reply("not a checkpoint");
  const std::string& state = reply.checkpoint().state();
  const std::byte* data = reinterpret_cast<const std::byte*>(state.data());
  return std::vector<std::byte>(data, data + state.size());
}

void RemoteSubdomain::resume(std::span<const std::byte> bytes) {
  caller_.request().mutable_resume()->set_state(bytes.data(), bytes.size());
  carry_flags();
  if (!caller_.call("resume").has_resumed()) caller_.refuse_reply("not a resumption");
}

std::uint64_t RemoteSubdomain::state_hash() {
  caller_.request().mutable_hash();
  carry_flags();
  const v1::Reply& reply = caller_.call("hash");
  if (!reply.has_hash()) caller_.refuse_reply("not a hash");
  return reply.hash().hash();
}

std::vector<double> RemoteSubdomain::measure() {
  if (description_.measures.empty()) return {};
  caller_.request().mutable_measure();
  carry_flags();
  const v1::Reply& reply = caller_.call("measure");
  if (!reply.has_measure()) caller_.refuse_reply("not measures");
  const auto& values = reply.measure().values();
  if (index(values.size()) != description_.measures.size())
    caller_.refuse_reply("measures of another number than its description says");
  return {values.begin(), values.end()};
}

Grid RemoteSubdomain::grid() {
  Grid grid;
  if (description_.fields.empty()) return grid;
  caller_.request().mutable_grid();
  carry_flags();
  const v1::Reply& reply = caller_.call("grid");
  if (!reply.has_grid()) caller_.refuse_reply("not a grid");
  try {
    decode(reply.grid(), grid);
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
  grid_size_ = {grid.nodes(), grid.cells()};
  return grid;
}

std::vector<FieldValues> RemoteSubdomain::fields() {
  std::vector<FieldValues> values;
  if (description_.fields.empty()) return values;
  if (!grid_size_) grid();
  caller_.request().mutable_fields();
  carry_flags();
  const v1::Reply& reply = caller_.call("fields");
  if (!reply.has_fields()) caller_.refuse_reply("not fields");
  try {
    decode(reply.fields(), description_, grid_size_->nodes, grid_size_->cells, values);
  } catch (const CodecError& error) {
    caller_.refuse_reply(error.what());
  }
  return values;
}

}  // namespace abut
