// SPDX-License-Identifier: MIT
#include "log_tap.h"

#include <mutex>
#include <string>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

namespace dynslam {
namespace {

LogLevel level_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::warn:
      return LogLevel::kWarn;
    case spdlog::level::err:
      return LogLevel::kError;
    case spdlog::level::critical:
      return LogLevel::kFatal;
    case spdlog::level::info:
      return LogLevel::kInfo;
    default:
      return LogLevel::kDebug;
  }
}

class PortSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  PortSink(Ports& ports, const Clock& clock) : ports_(ports), clock_(clock) {}

 private:
  void sink_it_(const spdlog::details::log_msg& line) override {
    const LogLine told{clock_.now(), level_of(line.level), {line.payload.data(), line.payload.size()}};
    ports_.log.push(told);
    ports_.recent_log.push(told);
  }
  void flush_() override {}

  Ports& ports_;
  const Clock& clock_;
};

}  // namespace

LogTap::LogTap(Ports& ports, const Clock& clock) : sink_(std::make_shared<PortSink>(ports, clock)) {
  spdlog::default_logger()->sinks().push_back(sink_);
}

LogTap::~LogTap() { std::erase(spdlog::default_logger()->sinks(), sink_); }

}  // namespace dynslam
