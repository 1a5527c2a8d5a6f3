#pragma once

#include <filesystem>
#include <string_view>

#include "coordinator/record/observer.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

/// events.jsonl: one JSON object per event and line, in the file as soon as it has happened.
class EventLog : public Observer {
 public:
  /// `opening`: of a resumed run, the file goes on.
  explicit EventLog(const std::filesystem::path& directory,
                    TextFile::Opening opening = TextFile::Opening::made);

  std::string_view kept_as() const override { return "events"; }
  void state(Archive& archive) override { file_.state(archive); }
  void on_event(const RunEvent& event) override;
  void on_end(const RunEnd&) override { file_.check_in_place(); }

 private:
  TextFile file_;
};

}  // namespace abut
