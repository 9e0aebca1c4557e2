// Every key of the viewer, in one table: input, the help overlay and `--help` are made from it.
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
  nextTexture,
  previousTexture,
  plan,
  times,
  measureError,
  frameAll,
  forwards,
  backwards,
  leftwards,
  rightwards,
  upwards,
  downwards,
  holdLight,
  largerSource,
  smallerSource,
  nextParameter,
  previousParameter,
  increase,
  decrease,
  resetParameter,
  reload,
  screenshot,
  saveConfig,
  hideOverlays,
  help,
  fullScreen,
  quit
};

enum class Held { no, yes };  ///< yes: acts as long as the key is down, and again when it is released

struct KeyBinding {
  Action action;
  int key;  ///< GLFW's
  bool control;
  const char* name;  ///< "Ctrl-S"
  const char* meaning;
  Held held = Held::no;
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

}  // namespace gnomon
