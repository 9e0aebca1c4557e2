// The viewer without its window: what is shown, and what keys and mouse change.
#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "document.h"
#include "gnomon/base/watch.h"
#include "gnomon/passes/overlay.h"
#include "gnomon/passes/present.h"
#include "gnomon/run/progressive.h"
#include "keys.h"
#include "stage.h"

namespace gnomon {

enum class MouseButton { left, right };

struct AppOptions {
  std::vector<std::filesystem::path> techniqueDirectories;
  /// Milliseconds. While something moves and a frame takes longer, the picture is drawn at a half or a quarter of the
  /// resolution; 0: never.
  double frameBudgetMs = 60.0;
};

/// What moves without a new set-up, and what the files say of it.
struct Pose {
  Light light;
  Camera camera;
  std::map<std::string, glm::dvec3> moves;  ///< of nodes, metres, world axes
  double time = 0.0;                        ///< seconds
};

class App {
 public:
  /// A current context is required. Throws InputError on faults in `subject`; see loadDocument.
  App(const std::filesystem::path& subject, AppOptions options);
  ~App();

  /// Size of the framebuffer in pixels, and pixels for each unit of the screen. A size of zero draws nothing.
  void resize(glm::ivec2 size, float scale);
  void press(Action action);
  void release(Action action);
  /// The window no longer gets keys: whatever was held is let go.
  void releaseAll();
  /// Positions in pixels from the top left.
  void moveMouse(glm::dvec2 to);
  void pressMouse(MouseButton button);
  void releaseMouse(MouseButton button);
  void wheel(double steps);
  /// Opens another config or scene; a fault in it is told on screen and changes nothing.
  void open(const std::filesystem::path& subject);
  /// The window lost what was drawn.
  void redraw() { dirty_ = true; }

  /// Lets held keys, the animation and changed files act. Returns whether the picture must be drawn again.
  bool advance(double seconds);
  /// Into the bound framebuffer.
  void draw();
  /// A slice of background work (the reference, errors), for about `milliseconds`. Returns whether there is more to do now.
  bool work(double milliseconds);

  /// Whether something is held or plays, so that frames follow one another.
  bool isMoving() const { return moving() || playing_ || !held_.empty(); }
  /// Whether no background work is left: the reference has all its rays, or there is none.
  bool isRefined() const;

  bool wantsToQuit() const { return quit_; }
  /// Whether full screen was asked for since the last call.
  bool takeFullScreenWish();
  /// Writes what the bound framebuffer shows.
  void writeScreenshot(const std::filesystem::path& path) const;
  /// The view as a run config that the runner reproduces.
  std::string stateAsConfig() const;
  std::string title() const;
  /// What the last frame showed and what it cost, as one line of JSON: for tests and bug reports.
  std::string frameLine() const;

 private:
  friend class Panels;

  enum class Moved { camera, light, nodes };
  /// A stage and which state of each of the three it has.
  struct Staged {
    std::unique_ptr<Stage> stage;
    std::array<std::uint64_t, 3> has{};
  };

  // What is looked at (document and reload: reload.cpp).
  void adopt(Document document);
  void openScene(std::size_t scene);
  void reloadFiles(const std::vector<std::filesystem::path>& changed);
  void reloadDocument();
  void replaceAll();
  void rebuildAll();
  /// Sets up at the window's size. Where that fails and `otherwiseKeep`, what was stays, at its own size.
  void rebuildStages(bool otherwiseKeep = false);
  std::string labelOf(std::size_t index) const;
  /// The stage of that factor, made if need be, with everything where it is now.
  Stage& stageOf(int reduction);
  /// After a movement: sets up again where the plan of the new pose is another.
  void settle();
  void moved(Moved what);
  std::vector<glm::dmat4> worlds() const;

  // What is shown.
  void select(std::size_t index);
  void flip(int by);
  void stepTexture(int by);
  bool moving() const { return sinceMoved_ < kRestSeconds; }
  /// Whether there is a reference for what is seen now.
  bool hasReference() const { return reference_ && referenceHas_ == versions_ && reference_->samples() > 0; }
  /// What the shown technique is compared with: its picture, or its visibility. Null while there is none.
  const TextureResource* other(Stage& stage, bool visibility);
  /// What is to be seen of a technique that has been rendered.
  PresentView view(Stage& stage, std::size_t shown, class Panels& panels);
  bool compares() const { return split_ || difference_ || (holdOther_ && againstReference_); }
  bool prepareReference();
  void chooseReduction(double frameMs);

  // What keys change.
  void editParameter(int steps);
  void resetParameter();
  void parametersChanged(const ResolvedTechnique& before);
  void nextCamera();
  void nextLight();
  void selectNode(int by);
  void pick(glm::dvec2 at);
  void moveNode(const glm::dvec3& by);
  glm::dvec3 nodeCentre() const;
  std::string lightName() const;
  /// All lights as they are now, in the config's order.
  std::vector<Light> lightsNow() const;
  void animate(double seconds);
  void fly(double seconds);
  void resetView();

  // What is handed over.
  void saveConfig();
  void saveScreenshot();
  void captureAll();

  /// For a few seconds.
  void say(std::string text) {
    message_ = std::move(text);
    sinceSaid_ = 0.0;
    dirty_ = true;
  }
  /// A trouble stays on screen until the same thing goes well; empty text: it does.
  void trouble(const std::string& what, const std::string& text);

  static constexpr double kRestSeconds = 0.25;  ///< without movement, until the picture counts as still

  AppOptions options_;
  std::shared_ptr<Libraries> libraries_;
  Document document_;
  Pose pose_;
  std::size_t light_ = 0;      ///< which one is worked with: its pose is pose_.light
  std::vector<Light> lights_;  ///< all, as they were left
  std::size_t cameraIndex_ = 0;
  std::vector<std::string> nodes_;  ///< names, each once
  std::optional<std::size_t> node_;
  std::map<int, Staged> stages_;                    ///< by the factor by which their resolution is lower
  std::array<std::uint64_t, 3> versions_{1, 1, 1};  ///< of camera, light and nodes
  std::unique_ptr<ProgressiveReference> reference_;
  std::array<std::uint64_t, 3> referenceHas_{};
  std::string referenceFault_;
  EffectPlan plan_;  ///< of the pose as it is

  std::size_t current_ = 0;
  std::size_t before_ = 0;
  std::optional<std::size_t> lastGood_;
  std::size_t shown_ = 0;  ///< in the last frame

  glm::ivec2 size_{0, 0};
  glm::ivec2 stageSize_{0, 0};
  float scale_ = 1.0f;
  double sinceResized_ = 1.0;
  int reduction_ = 1;
  bool split_ = false;
  bool difference_ = false;
  bool holdOther_ = false;
  bool againstReference_ = false;
  bool measureErrors_ = true;
  float divider_ = 0.5f;
  int texture_ = -1;  ///< -1: the picture
  std::size_t parameter_ = 0;
  bool showPlan_ = false;
  bool showTimes_ = false;
  bool showHelp_ = false;
  bool hidden_ = false;
  bool playing_ = false;
  bool fullScreenWish_ = false;
  bool screenshotWish_ = false;
  bool quit_ = false;
  bool dirty_ = true;
  bool compiling_ = false;      ///< this frame still shows the technique before
  std::size_t compiled_ = 0;    ///< which one is being compiled then
  bool compared_ = false;       ///< the last frame held both sides of the comparison
  bool cannotRebuild_ = false;  ///< at this size, until files or the size change
  double sinceSaid_ = 0.0;
  std::string message_;
  std::string inspected_;   ///< in the last frame: the texture and its value under the cursor
  std::string comparison_;  ///< in the last frame: what is compared, or why nothing is
  std::map<std::string, std::string> troubles_;
  double sinceOpenFailed_ = 0.0;

  std::set<Action> held_;
  std::optional<MouseButton> dragging_;
  bool draggingDivider_ = false;
  glm::dvec2 mouse_{0.0, 0.0};
  glm::dvec2 pressedAt_{0.0, 0.0};
  double sinceMoved_ = 1.0;
  bool settled_ = true;
  std::deque<float> frameTimes_;  ///< milliseconds of wall time
  std::uint64_t frames_ = 0;
  std::uint64_t events_ = 0;  ///< keys and clicks so far
  double sinceFileCheck_ = 0.0;
  FileWatch watch_;

  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<Presenter> presenter_;
};

}  // namespace gnomon
