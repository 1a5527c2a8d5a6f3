#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "base/fields.hpp"
#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// What the coordinator reads of a body that a program of somebody else makes: nothing of its keys,
/// which reach that program as they stand.
struct ExternalModel {
  static constexpr std::string_view name = "external";
  void fields(Fields& f) { f.ignore_rest(); }
};
struct ExternalBody {
  std::variant<ExternalModel> model;
  void fields(Fields& f);
};

/// Whether the scene gives this body `model: {external: ...}`.
bool is_external(const Document& document, const std::string& body);

/// Refuses what cannot start an external body. Throws InputError.
void check_external_launch(const BodyEntry& entry, const Document& document);
/// An external body is written out. Throws InputError.
void check_external_like(const BodyEntry& entry, const Document& document);
/// Refuses an external body where all bodies are to live in this process. Throws InputError.
void refuse_external_bodies(const Scene& scene, const Document& document);

}  // namespace abut
