#pragma once

#include <filesystem>

#include "coordinator/record/observer.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

/// events.jsonl: one JSON object per event and line, in the file as soon as it has happened.
class EventLog : public Observer {
 public:
  explicit EventLog(const std::filesystem::path& directory);

  void on_event(const RunEvent& event) override;
  void on_end(const RunEnd&) override { file_.check_in_place(); }

 private:
  TextFile file_;
};

}  // namespace abut
