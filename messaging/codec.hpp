#pragma once

#include <optional>
#include <stdexcept>

#include "abut/v1/subdomain.pb.h"
#include "contract/subdomain.hpp"
#include "messaging/channel.hpp"

namespace abut {

class WireWriter;
struct Specification;

/// A message that is well-formed protobuf but not a sound contract value: which field, and why.
class CodecError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses a message that is used again and again. What it carries of an Advance, a PassiveStep or
/// the reply to one is left where it is, in `bulk`, and only marked: whoever decodes it takes the
/// arrays from there, once.
/// False when the bytes are no such message.
bool parse_into(v1::Request& message, Bytes payload, Bytes& bulk);
bool parse_into(v1::Reply& message, Bytes payload, Bytes& bulk);

/// What a waveform of a surface may be wide.
struct SurfaceSize {
  int points = 0, dim = 1;
  int width() const { return points * dim; }
};
SurfaceSize size_of(const PortGeometry& surface);
/// Of the surfaces that each port has met, by port and partner.
using Partners = std::vector<std::vector<SurfaceSize>>;

/// A Meeting as it comes over the wire: `meeting` points to what stands beside it.
struct ReceivedMeeting {
  Meeting meeting;
  PortGeometry surface;
  PortKernel kernel;
  std::optional<int> first;  // pattern of a part; absent: the kernel is whole
  int patterns = 0;          // of the whole
};

// Contract to wire. The target may hold an earlier message: every field is overwritten, memory is
// kept.
void encode(const Advance& from, WireWriter& to);
/// Fields that the request does not want are left out.
void encode(const Response& from, const Advance& asked, WireWriter& to);
void encode(const PassiveStep& from, WireWriter& to);
void encode(const PassiveReply& from, WireWriter& to);
void encode(const Specification& from, v1::Configure& to);
void encode(const Failed& from, v1::Failed& to);
void encode(const Description& from, v1::Description& to);
/// `first`: the kernel is a part, which begins with this pattern.
void encode(const Meeting& from, std::optional<int> first, v1::Meet& to);
void encode(const Probing& from, v1::Probe& to);
void encode(const PortKernel& from, v1::PortKernel& to);
void encode(const Grid& from, v1::GridReply& to);
void encode(const std::vector<FieldValues>& from, v1::FieldsReply& to);

// Wire to contract. Shapes, counts, enums and finite numbers are checked; throws CodecError.
/// `body` and `met` tell how wide the waveforms of ports and partners are.
void decode(Bytes advance, const Description& body, const Partners& met, Advance& to);
/// Held against the request that it answers.
void decode(Bytes advanced, const Description& body, const Advance& asked, Response& to);
void decode(Bytes passive_step, const Description& body, PassiveStep& to);
/// Held against the step that it answers.
void decode(Bytes passive_stepped, const Description& body, const PassiveStep& asked,
            PassiveReply& to);
void decode(const v1::Configure& from, Specification& to);
void decode(const v1::Failed& from, Failed& to);
void decode(const v1::Description& from, Description& to);
void decode(const v1::Meet& from, const Description& body, const Partners& met,
            ReceivedMeeting& to);
void decode(const v1::Probe& from, const Description& body, Probing& to);
void decode(const v1::PortKernel& from, const Description& body, const Probing& asked,
            PortKernel& to);
void decode(const v1::GridReply& from, Grid& to);
/// Values may be other than finite: whoever writes fields says at which node or cell.
void decode(const v1::FieldsReply& from, const Description& body, std::size_t nodes,
            std::size_t cells, std::vector<FieldValues>& to);

/// Of all points whose compliance is wanted: rows of PassiveReply::compliance.
std::size_t pressed_values(const PassiveStep& asked, const Description& body);

/// What to do about a frame above the limit that carries this request or its reply.
const char* remedy_of_large_frame(const v1::Request& request);

/// Largest counts that a request may ask of a body.
inline constexpr int most_records = 1'000'000;
inline constexpr int most_kernel_steps = 1'000'000;

}  // namespace abut
