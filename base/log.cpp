#include "base/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <utility>

namespace abut {
namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::unique_ptr<spdlog::logger> make_logger(const std::string& program, LogLevel level) {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();  // spdlog's own ownership
  auto logger = std::make_unique<spdlog::logger>(program, std::move(sink));
  logger->set_pattern("%H:%M:%S.%e %n %l: %v");
  logger->set_level(spdlog_level(level));
  logger->flush_on(spdlog::level::debug);
  return logger;
}

std::unique_ptr<spdlog::logger>& logger() {
  static std::unique_ptr<spdlog::logger> instance = make_logger("abut", LogLevel::info);
  return instance;
}

}  // namespace

void start_log(const std::string& program, LogLevel level) {
  logger() = make_logger(program, level);
}

void log_info(const std::string& text) { logger()->log(spdlog::level::info, text); }
void log_warning(const std::string& text) { logger()->log(spdlog::level::warn, text); }
void log_error(const std::string& text) { logger()->log(spdlog::level::err, text); }

}  // namespace abut
