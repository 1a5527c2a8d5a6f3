#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/fields_reference.hpp"
#include "base/yaml_document.hpp"
#include "base/yaml_resolved.hpp"
#include "contract/body_facts.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/exact/closed_form.hpp"
#include "coordinator/scene.hpp"

namespace abut {

// The one place where the coordinator knows our own solver: bodies in this process, and what must
// be known of body keys before any process is started.

/// Every body of the scene, in its order, in this process. Throws InputError. Where `interrupted`
/// is given, a body that is advancing when it turns true throws RunError: a solve may take minutes.
std::vector<std::unique_ptr<Subdomain>> launch_local(
    const Scene& scene, const Document& document, const std::atomic<bool>* interrupted = nullptr);

/// What people want to know of every body of a scene that launch_local takes, in its order; none of
/// bodies of other programs. Throws InputError.
std::vector<std::optional<BodyFacts>> local_facts(const Scene& scene, const Document& document);

/// Reads the keys of every body entry that the document has. Throws InputError.
void check_body_keys(const Scene& scene, const Document& document);

/// Bars of linear elasticity that meet at the speeds of the begin keep something of their length:
/// refused is what a wave would compress to nothing. Throws InputError.
void check_speeds(const Scene& scene, const Document& document);

/// The exact solution that the scene names, if any, of bodies in its order. Throws InputError when
/// it does not describe them.
std::optional<ClosedForm> make_closed_form(const Scene& scene,
                                           const std::vector<const Description*>& bodies,
                                           const Document& document);

/// Adds the keys of a body entry to the reference.
void document_body_keys(Reference& reference);

/// Adds every body's values in use to the resolved scene.
void resolve_body_keys(const Scene& scene, const Document& document, ResolvedYaml& resolved);

}  // namespace abut
