// What rendering tests share: one headless context a process, the installation's registry, and a session in one call.
#pragma once

#include <memory>
#include <string>

#include "gnomon/base/json.h"
#include "gnomon/session.h"

namespace gnomon::test {

/// The context, made on first use and kept until the process ends.
void ensureContext();

/// The techniques that were built; opened on first use.
Registry& registry();

/// A built-in scene with its camera and light, as a session's set-up. `parametersJson` are the scene's keys.
SessionSetup builtinSetup(const std::string& scene, glm::ivec2 size = {200, 150}, const std::string& parametersJson = "{}");

/// A technique's parameters from JSON text such as R"({"taps": 5})"; a fault in them fails by InputError.
std::shared_ptr<void> parametersOf(const std::string& technique, const std::string& json);

Slot addSlot(Session& session, const std::string& technique, const std::string& json = "{}");

/// One frame's visibility. Throws Error on a refusal.
Image renderVisibility(SessionSetup setup, const std::string& technique, const std::string& json = "{}");

}  // namespace gnomon::test
