// Scene files: the document, all keys of the coordinator, and those of every body.
#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"
#include "subdomain_solver/make/read_body.hpp"
#include "tests/fuzz/hostile_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace abut;
  fuzz::read_or_refuse([=] {
    const Document document =
        Document::from_text("/nowhere/scene.yaml", fuzz::text_of(fuzz::input_of(data, size)));
    InputErrors errors;
    const Scene scene = read_scene(document, errors);
    for (const auto& body : scene.bodies)
      errors.gather([&] { read_body(document, "bodies." + body.first, body.second.context); });
    errors.raise();
  });
  return 0;
}
