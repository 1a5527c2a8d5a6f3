#include "coordinator/split/split_expectations.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <variant>

#include "base/yaml_document.hpp"

namespace abut {

namespace {

/// What a measure of the whole is of the parts: theirs under other names, or nothing, and why.
struct Meaning {
  std::vector<std::string> measures;
  std::string why;
};

Meaning of_none(std::string why) { return {{}, std::move(why)}; }

class Translator {
 public:
  explicit Translator(const Division& division) : division_(division) {}

  Meaning meaning(const Expectation& expectation) const {
    const std::vector<std::string> steps = split_path(expectation.measure);
    const std::string& first = steps[0];
    if (first == "schwarz" || first == "exchanges") return of_none("other bodies are iterated");
    if (first == "contact_windows") return of_none("joined bodies are iterated in every window");
    if (first == "windows" && division_.shorter_windows)
      return of_none("windows are of one step now");
    if (steps.size() < 2) return {{expectation.measure}, ""};
    if ((first == "momentum" || first == "angular_momentum") && steps[1] == "total")
      return of_all_momentum(expectation);
    if (first == "contact" && is_divided(steps[1])) return of_none("the interface is several now");
    if (first == "contact" || steps[1] != division_.whole.name) return {{expectation.measure}, ""};
    if (first == "energy") return of_none("energy passes between the parts");
    if (first == "momentum" || first == "angular_momentum")
      return of_none("it is the sum over the parts");
    if (first == "mean_velocity") return of_none("it is the mean over the parts");
    return of_body(expectation, steps);
  }

 private:
  bool is_divided(const std::string& interface) const {
    return std::ranges::count(division_.divided_interfaces, interface) > 0;
  }

  /// Of a change relative to the bodies' own momenta, which are larger together than that of the
  /// whole: it is no larger.
  static Meaning of_all_momentum(const Expectation& expectation) {
    const bool none = expectation.equals && *expectation.equals == 0.0;
    if (expectation.at_most || none) return {{expectation.measure}, ""};
    return of_none("it is relative to the momenta of the parts");
  }

  /// Of a measure whose second step is the body: those of some parts.
  Meaning of_parts(const std::vector<std::string>& steps,
                   const std::vector<std::size_t>& parts) const {
    Meaning meaning;
    for (const std::size_t part : parts) {
      std::string now = steps[0] + "." + division_.names[part];
      for (std::size_t k = 2; k < steps.size(); ++k) now = join_path(now, steps[k]);
      meaning.measures.push_back(now);
    }
    return meaning;
  }

  Meaning of_body(const Expectation& expectation, const std::vector<std::string>& steps) const {
    std::vector<std::size_t> parts(division_.names.size());
    for (std::size_t p = 0; p < parts.size(); ++p) parts[p] = p;
    if (std::ranges::count(steps, "reaction") > 0 && !is_static())
      return of_none("it is of the end of a step, and forces between parts are of whole steps");
    if (steps[2] == "rotation") return of_none("at records it looks at some cells alone");
    const std::string set = steps.size() > 3 ? division_.whole.set_called(steps[2]) : "";
    if (!set.empty()) {
      if (const std::optional<std::size_t> part = division_.where.alone_in(set))
        return of_parts(steps, {*part});
      parts = division_.where.parts_of(set);
    }
    const std::string_view last = steps.back();
    if (steps[2].starts_with("nodal_"))
      return of_none("nodes at a cut have cells of several parts");
    if (last == "max" && expectation.at_most) return of_parts(steps, parts);
    if (last == "min" && expectation.at_least) return of_parts(steps, parts);
    if (last == "max" || last == "min" || last == "max_of_cells")
      return of_none("which of the parts has it is not known");
    return of_none(last == "mean" ? "it is the mean over the parts"
                                  : "it is the sum or the mean over several parts");
  }

  bool is_static() const { return division_.whole.spec.integrates(SchemeKind::statics); }

  const Division& division_;
};

}  // namespace

SplitExpectations divide_expectations(const std::vector<Expectation>& expectations,
                                      const Division& division) {
  const Translator translator(division);
  SplitExpectations out;
  for (const Expectation& expectation : expectations) {
    const Meaning meaning = translator.meaning(expectation);
    if (meaning.measures.empty()) out.left_out.emplace_back(expectation.measure, meaning.why);
    for (const std::string& measure : meaning.measures) {
      out.kept.push_back(expectation);
      out.kept.back().measure = measure;
    }
  }
  return out;
}

}  // namespace abut
