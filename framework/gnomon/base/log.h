// Messages to people, on standard error. The logging library stays behind log.cpp.
#pragma once

#include <string>

namespace gnomon::log {

enum class Level { debug, info, warning, error, off };

void setLevel(Level level);
void debug(const std::string& message);
void info(const std::string& message);
void warning(const std::string& message);
void error(const std::string& message);

}  // namespace gnomon::log
