// What tests of the viewer share: a display, a folder with a config, and the pictures that came out.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "display.h"
#include "picture.h"
#include "temporary_folder.h"

namespace gnomon::test {

class ViewerWindow : public ::testing::Test {
 protected:
  ViewerWindow();

  /// 320x240 and never at lower resolution unless `more` says otherwise.
  std::vector<std::string> on(const std::string& subject, const std::vector<std::string>& more = {}) const;
  /// Plays a script to its end; fails when the viewer does.
  void play(const std::string& script, const std::string& subject = "config.json", const std::vector<std::string>& more = {});
  /// The frames of what was played; throws when nothing was.
  const std::vector<Json>& frames() const;
  /// Saves the view by its key; returns the config.
  Json savedConfig(const Viewer& viewer) const;

  /// Finished files that the viewer named by itself: not those under the temporary names that files have until they are whole.
  std::vector<std::string> handedOver(const std::string& ending) const;
  /// Presses the key for a screenshot and returns the file's bytes, which are gone then.
  std::string screenshot(const Viewer& viewer) const;
  /// The runner's picture of a config that the viewer saved, bytes of a PNG; empty when it made none.
  std::string runnersPicture(const std::string& config) const;
  std::string bytes(const std::string& file) const;
  Json json(const std::string& file) const;
  Picture picture(const std::string& file) const { return readPicture(folder_ / file); }

  /// A copy of a plugin's folder in techniques/NAME whose one technique, an entry of its own, is called `as`.
  std::filesystem::path copyOfPlugin(const std::string& plugin, const std::string& as) const;
  std::vector<std::string> withTechniques() const { return {"--technique-dir", (folder_ / "techniques").string()}; }

  TemporaryFolder folder_;
  Display display_;
  std::vector<Json> frames_;
};

}  // namespace gnomon::test
