#include "keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>

namespace gnomon {

std::span<const KeyBinding> keyBindings() {
  static constexpr std::array kTable{
      KeyBinding{Action::nextTechnique, GLFW_KEY_RIGHT, false, "Right", "next technique"},
      KeyBinding{Action::previousTechnique, GLFW_KEY_LEFT, false, "Left", "previous technique"},
      KeyBinding{Action::technique1, GLFW_KEY_1, false, "1", "the first technique"},
      KeyBinding{Action::technique2, GLFW_KEY_2, false, "2", "the second ... up to 0, the tenth"},
      KeyBinding{Action::technique3, GLFW_KEY_3, false, "3", ""},
      KeyBinding{Action::technique4, GLFW_KEY_4, false, "4", ""},
      KeyBinding{Action::technique5, GLFW_KEY_5, false, "5", ""},
      KeyBinding{Action::technique6, GLFW_KEY_6, false, "6", ""},
      KeyBinding{Action::technique7, GLFW_KEY_7, false, "7", ""},
      KeyBinding{Action::technique8, GLFW_KEY_8, false, "8", ""},
      KeyBinding{Action::technique9, GLFW_KEY_9, false, "9", ""},
      KeyBinding{Action::technique10, GLFW_KEY_0, false, "0", ""},
      KeyBinding{Action::lastTechnique, GLFW_KEY_TAB, false, "Tab", "back to the technique before"},
      KeyBinding{Action::split, GLFW_KEY_C, false, "C", "compare: split screen with the one before; drag the divider"},
      KeyBinding{Action::difference, GLFW_KEY_X, false, "X", "signed difference to the one before"},
      KeyBinding{Action::holdOther, GLFW_KEY_SPACE, false, "Space", "hold: show the one before", Held::yes},
      KeyBinding{Action::nextTexture, GLFW_KEY_V, false, "V", "look into the next texture of the technique's graph"},
      KeyBinding{Action::previousTexture, GLFW_KEY_B, false, "B", "the texture before; before the first, the picture"},
      KeyBinding{Action::plan, GLFW_KEY_G, false, "G", "effect plan and its reasons"},
      KeyBinding{Action::times, GLFW_KEY_T, false, "T", "time of each pass, frame times, memory"},
      KeyBinding{Action::measureError, GLFW_KEY_E, false, "E", "error against the reference (renders it: takes a moment)"},
      KeyBinding{Action::frameAll, GLFW_KEY_F, false, "F", "frame the whole scene"},
      KeyBinding{Action::forwards, GLFW_KEY_W, false, "W", "fly forwards", Held::yes},
      KeyBinding{Action::backwards, GLFW_KEY_S, false, "S", "fly backwards", Held::yes},
      KeyBinding{Action::leftwards, GLFW_KEY_A, false, "A", "fly left", Held::yes},
      KeyBinding{Action::rightwards, GLFW_KEY_D, false, "D", "fly right", Held::yes},
      KeyBinding{Action::upwards, GLFW_KEY_PAGE_UP, false, "PageUp", "fly up", Held::yes},
      KeyBinding{Action::downwards, GLFW_KEY_PAGE_DOWN, false, "PageDown", "fly down", Held::yes},
      KeyBinding{Action::holdLight, GLFW_KEY_L, false, "L", "hold: the mouse moves the light", Held::yes},
      KeyBinding{Action::largerSource, GLFW_KEY_RIGHT_BRACKET, false, "]", "larger source"},
      KeyBinding{Action::smallerSource, GLFW_KEY_LEFT_BRACKET, false, "[", "smaller source"},
      KeyBinding{Action::nextParameter, GLFW_KEY_DOWN, false, "Down", "next parameter"},
      KeyBinding{Action::previousParameter, GLFW_KEY_UP, false, "Up", "previous parameter"},
      KeyBinding{Action::increase, GLFW_KEY_EQUAL, false, "+", "increase the parameter, or its next choice"},
      KeyBinding{Action::decrease, GLFW_KEY_MINUS, false, "-", "decrease the parameter"},
      KeyBinding{Action::resetParameter, GLFW_KEY_BACKSPACE, false, "Backspace", "the parameter's default"},
      KeyBinding{Action::reload, GLFW_KEY_F5, false, "F5", "reload shaders, technique files and plugins"},
      KeyBinding{Action::screenshot, GLFW_KEY_F12, false, "F12", "screenshot of the window (PNG)"},
      KeyBinding{Action::saveConfig, GLFW_KEY_S, true, "Ctrl-S", "save what is seen as a run config"},
      KeyBinding{Action::hideOverlays, GLFW_KEY_H, false, "H", "hide or show all text"},
      KeyBinding{Action::help, GLFW_KEY_F1, false, "F1", "this help (also ?)"},
      KeyBinding{Action::help, GLFW_KEY_SLASH, false, "?", ""},
      KeyBinding{Action::fullScreen, GLFW_KEY_F11, false, "F11", "full screen"},
      KeyBinding{Action::quit, GLFW_KEY_ESCAPE, false, "Esc", "quit (also Ctrl-Q)"},
      KeyBinding{Action::quit, GLFW_KEY_Q, true, "Ctrl-Q", ""},
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
      MouseHabit{"drag", "orbit"},
      MouseHabit{"right drag", "pan"},
      MouseHabit{"wheel", "zoom"},
      MouseHabit{"L + drag", "move the light"},
  };
  return kTable;
}

}  // namespace gnomon
