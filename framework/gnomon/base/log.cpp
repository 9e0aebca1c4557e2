#include "gnomon/base/log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <string_view>
#include <utility>

namespace gnomon::log {
namespace {

/// "warning: ", "error: ", "debug: " before the message; nothing before an info.
class SeverityFlag final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string_view text = message.level == spdlog::level::warn    ? "warning: "
                                  : message.level == spdlog::level::err   ? "error: "
                                  : message.level == spdlog::level::debug ? "debug: "
                                                                          : "";
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<SeverityFlag>(); }
};

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<SeverityFlag>('*').set_pattern("%^%*%$%v");
    // Colours are used only where standard error is a terminal.
    auto sink = std::make_shared<spdlog::sinks::ansicolor_stderr_sink_mt>(spdlog::color_mode::automatic);
    auto made = std::make_shared<spdlog::logger>("gnomon", std::move(sink));
    made->set_formatter(std::move(formatter));
    made->set_level(spdlog::level::info);
    made->flush_on(spdlog::level::trace);
    return made;
  }();
  return *instance;
}

spdlog::level::level_enum toSpdlog(Level level) {
  switch (level) {
    case Level::debug:
      return spdlog::level::debug;
    case Level::info:
      return spdlog::level::info;
    case Level::warning:
      return spdlog::level::warn;
    case Level::error:
      return spdlog::level::err;
    case Level::off:
      break;
  }
  return spdlog::level::off;
}

void write(Level level, const std::string& message) {
  logger().log(toSpdlog(level), spdlog::string_view_t(message.data(), message.size()));
}

}  // namespace

void setLevel(Level level) {
  logger().set_level(toSpdlog(level));
}
void debug(const std::string& message) {
  write(Level::debug, message);
}
void info(const std::string& message) {
  write(Level::info, message);
}
void warning(const std::string& message) {
  write(Level::warning, message);
}
void error(const std::string& message) {
  write(Level::error, message);
}

}  // namespace gnomon::log
