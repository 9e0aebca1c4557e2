// Every key of the viewer, in one table: input, the help overlay, `--help` and docs/keys.md are made from it.
#pragma once

#include <span>
#include <string>

namespace gnomon {

enum class Action {
  nextTechnique,
  previousTechnique,
  technique1,
  technique2,
  technique3,
  technique4,
  technique5,
  technique6,
  technique7,
  technique8,
  technique9,
  technique10,
  lastTechnique,
  split,
  difference,
  holdOther,
  againstReference,
  measureError,
  nextTexture,
  previousTexture,
  plan,
  times,
  nextParameter,
  previousParameter,
  increase,
  decrease,
  resetParameter,
  frameAll,
  forwards,
  backwards,
  leftwards,
  rightwards,
  upwards,
  downwards,
  nextCamera,
  nextLight,
  nextScene,
  holdLight,
  largerSource,
  smallerSource,
  nextNode,
  holdNode,
  play,
  stepForwards,
  stepBackwards,
  resetView,
  reload,
  screenshot,
  capture,
  saveConfig,
  hideOverlays,
  help,
  fullScreen,
  quit
};

/// What a key does while it stays down. Toggles must not repeat: a slow machine would turn one press into two.
enum class Habit {
  once,
  repeats,  ///< with the keyboard's repetition
  held      ///< acts as long as it is down, and again when it is released
};

struct KeyBinding {
  Action action;
  int key;  ///< GLFW's
  bool control;
  const char* name;     ///< "Ctrl-S"
  const char* meaning;  ///< empty: said at another key of the action
  Habit habit = Habit::once;
  const char* heading = "";  ///< of the group that begins here
};

std::span<const KeyBinding> keyBindings();
/// The binding of a key, or null.
const KeyBinding* bindingOf(int key, bool control);
/// A key by the name that scripts use ("Right", "F1", "Ctrl-S"), or null.
const KeyBinding* bindingNamed(const std::string& name);

/// What the mouse does: name and meaning.
struct MouseHabit {
  const char* name;
  const char* meaning;
};
std::span<const MouseHabit> mouseHabits();

/// All of it as lines of text, and as the page docs/keys.md.
std::string keysAsText();
std::string keysAsMarkdown();

}  // namespace gnomon
