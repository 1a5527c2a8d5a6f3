#include "coordinator/record/event_log.hpp"

#include <nlohmann/json.hpp>

namespace abut {

EventLog::EventLog(const std::filesystem::path& directory, TextFile::Opening opening)
    : file_(directory / "events.jsonl", opening) {}

void EventLog::on_event(const RunEvent& event) {
  // Made an object before its members are: the library crashes where memory fails between.
  nlohmann::ordered_json line = nlohmann::ordered_json::object();
  line["time"] = event.time;  // a number that is not finite becomes null
  line["kind"] = to_string(event.kind);
  line["subject"] = event.subject;
  line["text"] = event.text;
  line["values"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : event.values) line["values"][name] = value;
  // Names and texts may come from elsewhere: bytes that are not UTF-8 are replaced, never thrown
  // upon. With its end at once: where that alone cannot be written, the next event, of the failure,
  // would stand in the same line.
  file_.append(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  file_.flush();
}

}  // namespace abut
