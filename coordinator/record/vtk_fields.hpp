#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/record/observer.hpp"
#include "coordinator/record/paraview_state.hpp"
#include "coordinator/record/text_file.hpp"
#include "coordinator/record/vtu_file.hpp"

namespace abut {

/// Fields of all bodies that have some, for ParaView: fields/BODY_WINDOWS.vtu for every state
/// written, and fields.pvd, which lists them with their times and can be opened at any time of the
/// run (docs/OUTPUT.md). States: the begin, after every so many accepted windows, and the end of a
/// run that did not fail. Beside them fields.pvsm, with which ParaView shows all of it at once.
/// Asks the bodies itself, in states that the run has accepted.
class VtkFields : public Observer {
 public:
  /// The bodies, in the scene's order, must outlive this. `every` [windows] is positive.
  VtkFields(const std::filesystem::path& directory, std::vector<Subdomain*> bodies, int every,
            TextFile::Opening opening = TextFile::Opening::made);

  std::string_view kept_as() const override { return "fields"; }
  void state(Archive& archive) override;

  /// All of these throw RunError: files that cannot be written, bodies lost, values not finite.
  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_end(const RunEnd& end) override;

 private:
  struct Shown {  // a body that has fields
    Subdomain* body;
    VtuFile file;
  };

  void write(double time);
  void remove_later() const;
  void write_view() const;  // fields.pvsm

  std::filesystem::path directory_;
  std::vector<Subdomain*> bodies_;
  std::int64_t every_;
  TextFile::Opening opening_;
  std::vector<Shown> shown_;
  ParaviewView view_;
  std::optional<TextFile> list_;  // fields.pvd
  std::int64_t windows_ = 0;      // accepted so far
  double written_ = 0.0;          // [s] time of the last state
};

}  // namespace abut
