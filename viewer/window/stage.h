// A session at one resolution, with a slot for each technique that has been looked at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gnomon/run/resolve.h"
#include "gnomon/session.h"

namespace gnomon {

/// What one technique does on a stage.
struct StageEntry {
  std::optional<Slot> slot = {};          ///< of the light that is worked with; set up on first use
  std::vector<Slot> others = {};          ///< of the other lights, in their order
  std::optional<Slot> sum = {};           ///< the picture of all of them, where there are others
  std::string failure = {};               ///< why it shows nothing; empty while it works
  std::string refusal = {};               ///< of the light that is worked with, where others are shown all the same
  std::vector<std::string> leftOut = {};  ///< lights that the picture lacks, a sentence each
  std::vector<PassReport> passes = {};    ///< the last run of each
  bool timed = false;                     ///< passes have been timed one by one
  double cpuMs = 0.0;                     ///< of the last frame in which any of its passes ran
  double wallMs = 0.0;
};

class Stage {
 public:
  /// The setup's first light is the one that is worked with: measured, compared, looked into. A current context is required.
  /// Throws Error.
  Stage(SessionSetup setup, std::size_t techniques) : session_(std::move(setup)), entries_(techniques) {}

  Session& session() { return session_; }
  const Session& session() const { return session_; }
  const StageEntry& entry(std::size_t index) const { return entries_.at(index); }
  /// What a technique makes of all lights, of the last frame.
  const TextureResource& shaded(std::size_t index) const {
    const StageEntry& e = entries_.at(index);
    return session_.shadedTexture(e.sum ? *e.sum : *e.slot);
  }
  bool isCold(std::size_t index) const { return !entries_.at(index).slot && entries_.at(index).failure.empty(); }

  /// Runs what changed, and sets up on first use. With `timePasses` every pass runs once and is timed by itself, later ones
  /// only when they change. False: it has nothing to show, see failure.
  bool render(std::size_t index, const ResolvedTechnique& technique, bool timePasses);
  /// Values of its parameters have changed. Returns why it could not be set up with them: then the ones before still hold.
  std::string change(std::size_t index, const ResolvedTechnique& technique);
  /// Its code, shaders or preset have changed. Returns why it could not be set up: then what last worked stays.
  std::string replace(std::size_t index, const ResolvedTechnique& technique);
  /// Passes are timed one by one again.
  void forgetTimes();
  /// Passes run in all frames so far, shared ones too.
  std::uint64_t passesRun() const { return passesRun_; }

  /// Shows a visibility made elsewhere.
  void showPicture(const std::shared_ptr<TextureResource>& visibility);
  const std::optional<Slot>& picture() const { return picture_; }
  /// Shades the picture.
  void renderPicture();

 private:
  std::string refusalOf(Slot slot) const { return session_.support(slot).refusal; }
  void setUp(StageEntry& entry, const ResolvedTechnique& technique);
  /// Which lights are refused now.
  void judge(StageEntry& entry) const;

  Session session_;
  std::vector<StageEntry> entries_;
  std::optional<Slot> picture_;
  std::uint64_t passesRun_ = 0;
};

}  // namespace gnomon
