#include "messaging/remote_subdomain.hpp"

#include <algorithm>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "contract/kernel_parts.hpp"
#include "contract/no_answer.hpp"
#include "messaging/soundness.hpp"

namespace abut {

namespace {

/// [B] of a kernel's part: larger ones are no faster, and their copies take memory.
constexpr std::size_t usual_part = std::size_t{32} << 20;
/// [B] of a message with a kernel beside its patterns.
constexpr std::size_t beside_patterns = 1024;

/// Patterns of a part, of `each` bytes; at least one, which whoever makes the frame refuses where
/// it is too large.
int patterns_at_once(std::size_t patterns, std::size_t each, std::size_t beside,
                     std::size_t limit) {
  beside += beside_patterns;
  const std::size_t room = std::min(usual_part, limit > beside ? limit - beside : 0);
  return static_cast<int>(std::clamp<std::size_t>(room / std::max<std::size_t>(each, 1), 1,
                                                  std::max<std::size_t>(patterns, 1)));
}

}  // namespace

void RemoteSubdomain::start_configure(const Specification& specification) {
  encode(specification, *caller_.request().mutable_configure());
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

void RemoteSubdomain::meet(const Meeting& meeting) {
  if (meeting.kernel == nullptr) return meet_part(meeting, {});
  const PortKernel& kernel = *meeting.kernel;
  int at_once =
      patterns_at_once(index(kernel.patterns), bytes_of_pattern(kernel),
                       sizeof(std::int32_t) * kernel.points.size(), caller_.frame_limit());
  if (const int dim = kernel.band.dim; dim > 0) at_once = std::max(dim, at_once - at_once % dim);
  if (meeting.surface != nullptr)
    meet_part({meeting.port, meeting.partner, meeting.surface, meeting.law}, {});
  if (at_once >= kernel.patterns)
    return meet_part({meeting.port, meeting.partner, nullptr, {}, &kernel}, {});
  for (int first = 0; first < kernel.patterns; first += at_once) {
    const PortKernel part = part_of(kernel, first, std::min(at_once, kernel.patterns - first));
    meet_part({meeting.port, meeting.partner, nullptr, {}, &part}, first);
  }
}

void RemoteSubdomain::meet_part(const Meeting& meeting, std::optional<int> first) {
  encode(meeting, first, *caller_.request().mutable_meet());
  carry_flags();
  if (!caller_.call("meet").has_met()) caller_.refuse_reply("not a meeting");
}

void RemoteSubdomain::carry_flags() { flags_.ride(caller_.request()); }

void RemoteSubdomain::start(const Advance& request) {
  asked_ = &request;
  carry_flags();
  caller_.post(request);
}

Outcome RemoteSubdomain::finish(Response& response) {
  const v1::Reply& reply = caller_.await();
  try {
    if (reply.has_advanced()) {
      decode(caller_.bulk(), description_, *asked_, response);
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

PortKernel RemoteSubdomain::probe(const Probing& asked) {
  const auto& [port, patterns, step, count, seen] = asked;
  const auto width_of = [this](int p) { return description_.ports[p].geometry.points.size(); };
  const std::size_t pressed = width_of(port), all = patterns.size() / pressed;
  std::size_t width = seen.empty() ? pressed : 0;
  for (const int p : seen) width += width_of(p);
  // Displacements, and those of the port itself by forces at the begin and at once.
  const std::size_t each = sizeof(double) * width * (index(count) * (seen.empty() ? 2 : 1) + 1);
  const std::size_t motions = index(loose_motions(description_));
  const std::size_t at_once =
      index(patterns_at_once(all, std::max(each, sizeof(double) * pressed),
                             sizeof(double) * motions * (width + motions), caller_.frame_limit()));
  ABUT_ASSERT(all > 0 && patterns.size() == all * pressed);
  PortKernel whole;
  for (std::size_t first = 0; first < all; first += at_once) {
    if (at_once >= all) return probe_part(asked);
    const auto from = patterns.begin() + static_cast<std::ptrdiff_t>(first * pressed);
    const auto some = static_cast<std::ptrdiff_t>(std::min(at_once, all - first) * pressed);
    const PortKernel answer = probe_part({port, {from, from + some}, step, count, seen});
    if (first == 0) whole = room_for(answer, static_cast<int>(all));
    if (!fits(answer, static_cast<int>(first), whole))
      caller_.refuse_reply("kernel has other arrays than that of the patterns before");
    put(answer, static_cast<int>(first), whole);
  }
  return whole;
}

PortKernel RemoteSubdomain::probe_part(const Probing& probing) {
  encode(probing, *caller_.request().mutable_probe());
  carry_flags();
  const v1::Reply& reply = caller_.call("probe");
  if (!reply.has_kernel() && !reply.has_failed()) caller_.refuse_reply("not a kernel");
  PortKernel result;
  try {
    if (reply.has_failed()) {
      Failed failed;
      decode(reply.failed(), failed);
      throw NoAnswer(failed, description_.name);
    }
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
