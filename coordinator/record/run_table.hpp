#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/observer.hpp"

namespace abut {

/// What happened, for people, when a run has ended: contacts, reactions of what is held, energies,
/// and on whom the others waited. Contacts are those of the measures; the rest is seen here.
class RunTable : public Observer {
 public:
  std::string_view kept_as() const override { return "table"; }
  void state(Archive& archive) override;
  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_end(const RunEnd& end) override { end_ = end; }

  /// After the end. Units are named in brackets, as SI's.
  std::string text(const Measures& measures) const;
  /// Who made the others wait. `waited` [s] by body: wall time for which each was waited for;
  /// processes hold bodies of these indices each; none: all are in one.
  std::string times(std::span<const double> waited,
                    const std::vector<std::vector<std::size_t>>& processes) const;

 private:
  struct Held {                        // a constraint of a body
    std::size_t body = 0, column = 0;  // its first column
    int axes = 0;
    std::string name;
    double peak = 0.0, time = 0.0;  // [N] [s] of the largest force
    std::vector<double> last;       // [N] (axes)
  };
  std::string contacts(const Measures& measures) const;
  std::string reactions() const;
  std::string energies(const Measures& measures) const;
  void read(const BodyRecord& record, std::size_t body);

  RunStart start_;
  RunEnd end_;
  std::vector<Held> held_;
  std::vector<Energy> first_, last_;  // by body
};

}  // namespace abut
