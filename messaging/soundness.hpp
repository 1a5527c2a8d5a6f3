#pragma once

#include "contract/subdomain.hpp"
#include "messaging/codec.hpp"
#include "messaging/codec/parts.hpp"

namespace abut {

// What is decoded has whole arrays and finite numbers. Here it is held against what it is for: the
// one place that decides what a complete and sound message of a peer is. All throw CodecError with
// the name of the field.

/// A surface as geometry relies on it, whatever it will be used for: facets of known sizes without
/// repeated nodes, with area, that look as their neighbours do; normals of unit length that look
/// where the facets do.
void require_sound(const PortGeometry& surface, const FieldPath& path);
/// What a body tells of itself.
void require_sound(const Description& body);
/// A request to advance: nothing is in it that the body does not take.
void require_taken(const Advance& asked, const Description& body);
/// A reply to a window: every part is there that what the body can do entails, boxes hold what they
/// are of, and no bound of speed is below the speed.
void require_sound(const Response& reply, const Description& body, const Advance& asked);
/// A reply to a passive step: of its end, with a compliance that can be one.
void require_sound(const PassiveReply& reply, const Description& body, const PassiveStep& asked);
/// Responses of a port: all that were asked for, none against its force.
void require_sound(const PortKernel& kernel, const Description& body, const Probing& asked);

}  // namespace abut
