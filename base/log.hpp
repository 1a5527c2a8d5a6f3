#pragma once

#include <string>

namespace abut {

/// What people are told while a program works, on standard error, one line per event. Text is built
/// with fmt by the caller. Results go to standard output and do not pass here.
enum class LogLevel { debug, info, warning, error };

/// Lines below the level are dropped; `program` stands at the head of every line. Without this call
/// the level is info.
void start_log(const std::string& program, LogLevel level);

void log_info(const std::string& text);
void log_warning(const std::string& text);
void log_error(const std::string& text);

}  // namespace abut
