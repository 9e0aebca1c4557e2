#include "keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <array>

namespace gnomon {

std::span<const KeyBinding> keyBindings() {
  using enum Action;
  static constexpr Habit kRepeats = Habit::repeats;
  static constexpr Habit kHeld = Habit::held;
  static constexpr std::array kTable{
      KeyBinding{nextTechnique, GLFW_KEY_RIGHT, false, "Right", "next technique", kRepeats, "Flip"},
      KeyBinding{previousTechnique, GLFW_KEY_LEFT, false, "Left", "previous technique", kRepeats},
      KeyBinding{technique1, GLFW_KEY_1, false, "1", "the first technique"},
      KeyBinding{technique2, GLFW_KEY_2, false, "2", "the second ... up to 0, the tenth"},
      KeyBinding{technique3, GLFW_KEY_3, false, "3", ""},
      KeyBinding{technique4, GLFW_KEY_4, false, "4", ""},
      KeyBinding{technique5, GLFW_KEY_5, false, "5", ""},
      KeyBinding{technique6, GLFW_KEY_6, false, "6", ""},
      KeyBinding{technique7, GLFW_KEY_7, false, "7", ""},
      KeyBinding{technique8, GLFW_KEY_8, false, "8", ""},
      KeyBinding{technique9, GLFW_KEY_9, false, "9", ""},
      KeyBinding{technique10, GLFW_KEY_0, false, "0", ""},
      KeyBinding{lastTechnique, GLFW_KEY_TAB, false, "Tab", "back to the technique before"},
      KeyBinding{split, GLFW_KEY_C, false, "C", "compare: split screen with the one before; drag the divider", Habit::once,
                 "Compare"},
      KeyBinding{difference, GLFW_KEY_X, false, "X", "signed difference to the one before"},
      KeyBinding{holdOther, GLFW_KEY_SPACE, false, "Space", "hold: show the one before", kHeld},
      KeyBinding{againstReference, GLFW_KEY_R, false, "R", "compare with the reference instead (C, X, Space)"},
      KeyBinding{measureError, GLFW_KEY_E, false, "E", "error on or off: the reference refines while nothing moves"},
      KeyBinding{nextTexture, GLFW_KEY_V, false, "V", "look into the next texture of the technique's graph", kRepeats,
                 "See inside"},
      KeyBinding{previousTexture, GLFW_KEY_B, false, "B", "the texture before; before the first, the picture", kRepeats},
      KeyBinding{plan, GLFW_KEY_G, false, "G", "effect plan and its reasons"},
      KeyBinding{times, GLFW_KEY_T, false, "T", "time of each pass, frame times, memory"},
      KeyBinding{nextParameter, GLFW_KEY_DOWN, false, "Down", "next parameter", kRepeats, "Parameters"},
      KeyBinding{previousParameter, GLFW_KEY_UP, false, "Up", "previous parameter", kRepeats},
      KeyBinding{increase, GLFW_KEY_EQUAL, false, "+", "increase the parameter, or its next choice", kRepeats},
      KeyBinding{increase, GLFW_KEY_KP_ADD, false, "keypad +", "", kRepeats},
      KeyBinding{decrease, GLFW_KEY_MINUS, false, "-", "decrease the parameter, or its choice before", kRepeats},
      KeyBinding{decrease, GLFW_KEY_KP_SUBTRACT, false, "keypad -", "", kRepeats},
      KeyBinding{resetParameter, GLFW_KEY_BACKSPACE, false, "Backspace", "the parameter as the files have it"},
      KeyBinding{frameAll, GLFW_KEY_F, false, "F", "frame the whole scene", Habit::once, "Move"},
      KeyBinding{forwards, GLFW_KEY_W, false, "W", "fly forwards (S back, A left, D right)", kHeld},
      KeyBinding{backwards, GLFW_KEY_S, false, "S", "", kHeld},
      KeyBinding{leftwards, GLFW_KEY_A, false, "A", "", kHeld},
      KeyBinding{rightwards, GLFW_KEY_D, false, "D", "", kHeld},
      KeyBinding{upwards, GLFW_KEY_PAGE_UP, false, "PageUp", "fly up (PageDown down)", kHeld},
      KeyBinding{downwards, GLFW_KEY_PAGE_DOWN, false, "PageDown", "", kHeld},
      KeyBinding{nextCamera, GLFW_KEY_K, false, "K", "next camera of the config and the scene's file"},
      KeyBinding{nextLight, GLFW_KEY_J, false, "J", "next light"},
      KeyBinding{nextScene, GLFW_KEY_O, false, "O", "next scene of the config"},
      KeyBinding{holdLight, GLFW_KEY_L, false, "L", "hold: mouse and wheel move the light", kHeld},
      KeyBinding{largerSource, GLFW_KEY_RIGHT_BRACKET, false, "]", "larger source", kRepeats},
      KeyBinding{smallerSource, GLFW_KEY_LEFT_BRACKET, false, "[", "smaller source", kRepeats},
      KeyBinding{nextNode, GLFW_KEY_N, false, "N", "next node of the scene (or click on it)"},
      KeyBinding{holdNode, GLFW_KEY_M, false, "M", "hold: mouse and wheel move the node", kHeld},
      KeyBinding{play, GLFW_KEY_P, false, "P", "play or pause the scene's animation"},
      KeyBinding{stepForwards, GLFW_KEY_PERIOD, false, ".", "a step of 1/30 s forwards", kRepeats},
      KeyBinding{stepBackwards, GLFW_KEY_COMMA, false, ",", "a step of 1/30 s backwards", kRepeats},
      KeyBinding{resetView, GLFW_KEY_HOME, false, "Home", "camera, light, nodes and time as the files say"},
      KeyBinding{reload, GLFW_KEY_F5, false, "F5", "reload config, techniques, plugins and shaders", Habit::once, "Hand over"},
      KeyBinding{screenshot, GLFW_KEY_F12, false, "F12", "screenshot of the window (PNG)"},
      KeyBinding{capture, GLFW_KEY_E, true, "Ctrl-E", "capture every technique's views and textures (EXR)"},
      KeyBinding{saveConfig, GLFW_KEY_S, true, "Ctrl-S", "save what is seen as a run config"},
      KeyBinding{hideOverlays, GLFW_KEY_H, false, "H", "hide or show all text", Habit::once, "Window"},
      KeyBinding{help, GLFW_KEY_F1, false, "F1", "this help (also ?)"},
      KeyBinding{help, GLFW_KEY_SLASH, false, "?", ""},
      KeyBinding{fullScreen, GLFW_KEY_F11, false, "F11", "full screen"},
      KeyBinding{quit, GLFW_KEY_ESCAPE, false, "Esc", "quit (also Ctrl-Q)"},
      KeyBinding{quit, GLFW_KEY_Q, true, "Ctrl-Q", ""},
  };
  return kTable;
}

const KeyBinding* bindingOf(int key, bool control) {
  for (const KeyBinding& binding : keyBindings()) {
    if (binding.key == key && binding.control == control) return &binding;
  }
  return nullptr;
}

const KeyBinding* bindingNamed(const std::string& name) {
  for (const KeyBinding& binding : keyBindings()) {
    if (name == binding.name) return &binding;
  }
  return nullptr;
}

std::span<const MouseHabit> mouseHabits() {
  static constexpr std::array kTable{
      MouseHabit{"drag", "orbit; the divider: move it"},
      MouseHabit{"right drag", "pan"},
      MouseHabit{"wheel", "zoom"},
      MouseHabit{"click", "select the node"},
      MouseHabit{"L + drag", "turn the light about its target"},
      MouseHabit{"L + right drag", "move the light with its target"},
      MouseHabit{"L + wheel", "the light nearer or farther"},
      MouseHabit{"M + drag", "move the node across the view"},
      MouseHabit{"M + wheel", "the node nearer or farther"},
      MouseHabit{"drop a file", "open a glTF or a run config"},
  };
  return kTable;
}

std::string keysAsText() {
  std::string text;
  for (const KeyBinding& b : keyBindings()) {
    if (b.heading[0] != '\0') text += fmt::format("{}:\n", b.heading);
    if (b.meaning[0] != '\0') text += fmt::format("  {:<15} {}\n", b.name, b.meaning);
  }
  text += "Mouse:\n";
  for (const MouseHabit& m : mouseHabits()) text += fmt::format("  {:<15} {}\n", m.name, m.meaning);
  return text;
}

std::string keysAsMarkdown() {
  std::string text = "# Keys of `gnomon-view`\n\nWritten by `gnomon-view --keys`; F1 shows them in the window.\n";
  const auto heading = [&](const char* name) { text += fmt::format("\n## {}\n\n| | does |\n|---|---|\n", name); };
  for (const KeyBinding& b : keyBindings()) {
    if (b.heading[0] != '\0') heading(b.heading);
    if (b.meaning[0] != '\0') text += fmt::format("| `{}` | {} |\n", b.name, b.meaning);
  }
  heading("Mouse");
  for (const MouseHabit& m : mouseHabits()) text += fmt::format("| {} | {} |\n", m.name, m.meaning);
  return text;
}

}  // namespace gnomon
