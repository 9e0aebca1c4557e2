// What the checks share: the technique on a small stage that it accepts, rendered in one call.
#pragma once

#include <memory>
#include <string>

#include "gnomon/base/json.h"
#include "gnomon/check/check.h"
#include "gnomon/session.h"
#include "gnomon/stability/promises.h"

namespace gnomon::check {

inline constexpr glm::ivec2 kOutput{64, 48};

/// The technique, and where it is looked at.
struct Subject {
  Registry& registry;
  OpenTechnique technique;
  OpenTechnique neighbour;   ///< another technique, to run before and after it; itself where there is no other
  SessionSetup stage;        ///< of kOutput; with the first light of several kinds that the technique does not refuse
  std::string refusal = {};  ///< why it refuses all of them; empty: it does not

  const std::string& name() const { return technique.registered->declaration.name; }
  SessionSetup stageOf(glm::ivec2 size) const;
};

/// Throws InputError for a name that is not registered and a library that cannot be used, and Error for what set-up throws.
Subject makeSubject(Registry& registry, const std::string& technique);

/// Values by the technique's file, and then by `overrides`. Throws InputError.
std::shared_ptr<void> parametersOf(Registry& registry, const OpenTechnique& technique, const Json& overrides);
std::shared_ptr<void> parametersOf(const Subject& subject);

/// A slot of the subject. Throws Error where it refuses.
Slot addSlot(Session& session, const Subject& subject);

/// Renders everything, also what did not change.
Image renderAgain(Session& session, Slot slot);
/// A fresh session's first frame, with its own preset.
Image renderFresh(const Subject& subject, const SessionSetup& setup);

/// "12 of 3072 pixels differ, the first at (3, 4) by 0.25"; images of one shape that differ.
std::string difference(const Image& a, const Image& b);

Finding passed(std::string text);
Finding failed(std::string text);

// The checks; checks() says what each is for.
Finding checkContract(const Subject& subject);
Finding checkParameters(const Subject& subject);
Finding checkSizes(const Subject& subject);
Finding checkBits(const Subject& subject);
Finding checkInputs(const Subject& subject);
Finding checkState(const Subject& subject);
Finding checkLeaks(const Subject& subject);
Finding checkAccuracy(const Subject& subject);
Finding checkStability(const Subject& subject);

}  // namespace gnomon::check
