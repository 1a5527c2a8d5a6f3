#include "coordinator/adjusted_body.hpp"

#include "base/fields.hpp"
#include "base/yaml_fields.hpp"

namespace abut {

namespace {

struct AdjustKey {
  bool adjust = false;
  void fields(Fields& f) {
    f.optional("adjust", adjust, "", "whether its surfaces are moved");
    f.ignore_rest();
  }
};

}  // namespace

bool is_adjusted(const Document& document, const std::string& body) {
  const std::string path = "bodies." + body + ".initial";
  return document.has(path + ".adjust") && read<AdjustKey>(document, path).adjust;
}

}  // namespace abut
