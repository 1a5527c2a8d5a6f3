#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/exact/closed_form.hpp"
#include "coordinator/record/balance_measures.hpp"
#include "coordinator/record/contact_measures.hpp"
#include "coordinator/record/many_contacts.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/observer.hpp"

namespace abut {

/// Turns a run into measures: docs/OUTPUT.md says what each one means. Complete
/// after on_end, so it is told of the end before those who read it.
class MeasureRecorder : public Observer {
 public:
  /// `form` may be null; else it must outlive this. `filter`: of contact forces; `steady_after`:
  /// [s] from when their ripple counts.
  explicit MeasureRecorder(const ClosedForm* form, std::optional<ForceFilterSpec> filter = {},
                           std::optional<double> steady_after = {})
      : form_(form), filter_(filter), steady_after_(steady_after) {}

  std::string_view kept_as() const override { return "measures"; }
  void state(Archive& archive) override;
  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_event(const RunEvent& event) override;
  void on_end(const RunEnd& end) override;

  const Measures& measures() const { return measures_; }
  /// The first number of the run that was not finite, as a sentence; empty: all were.
  const std::string& non_finite() const { return non_finite_; }

 private:
  struct PositionMax {
    int body, port;
    std::vector<double> most;  // [m] (dim)
  };

  void count_iterations(const WindowReport& report);
  void follow_positions(const WindowReport& report);
  void check_finite(const WindowReport& report);
  void write_positions();
  void write_told(const RunEnd& end);

  const ClosedForm* form_;
  std::optional<ForceFilterSpec> filter_;
  std::optional<double> steady_after_;
  RunStart start_;
  std::vector<ContactMeasures> contacts_;
  std::vector<ManyContacts> many_;
  std::optional<BalanceMeasures> balance_;
  std::vector<PositionMax> positions_;
  std::int64_t contact_windows_ = 0, iterations_ = 0;
  int iterations_max_ = 0;
  double last_time_ = 0.0;
  Measures measures_;
  std::string non_finite_;
};

}  // namespace abut
