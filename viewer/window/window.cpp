#include "window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "app.h"
#include "gnomon/base/error.h"

namespace gnomon {

struct Window::State {
  GLFWwindow* window = nullptr;
  App* app = nullptr;
  std::string title;
  glm::ivec2 windowedAt{0, 0};
  glm::ivec2 windowedSize{1280, 720};

  static State& of(GLFWwindow* window) { return *static_cast<State*>(glfwGetWindowUserPointer(window)); }

  glm::dvec2 toPixels(double x, double y) const {
    glm::ivec2 screen(1);
    glm::ivec2 pixels(1);
    glfwGetWindowSize(window, &screen.x, &screen.y);
    glfwGetFramebufferSize(window, &pixels.x, &pixels.y);
    return glm::dvec2(x, y) * glm::dvec2(pixels) / glm::dvec2(std::max(screen.x, 1), std::max(screen.y, 1));
  }
};

namespace {

std::string lastGlfwError() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "no reason given" : text;
}

}  // namespace

Window::Window(const std::string& title, glm::ivec2 size) : state_(std::make_unique<State>()) {
  constexpr const char* kInstead = " Without a display, `gnomon render CONFIG` makes the same pictures.";
  if (glfwInit() != GLFW_TRUE) throw Error("no window can be opened: " + lastGlfwError() + "." + kInstead);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  state_->window = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
  if (state_->window == nullptr) {
    const std::string why = lastGlfwError();
    glfwTerminate();
    throw Error("no OpenGL 4.5 window: " + why + "." + kInstead);
  }
  glfwSetWindowUserPointer(state_->window, state_.get());
  glfwMakeContextCurrent(state_->window);
  glfwSwapInterval(1);

  glfwSetKeyCallback(state_->window, [](GLFWwindow* w, int key, int, int event, int modifiers) {
    App* app = State::of(w).app;
    const KeyBinding* binding = bindingOf(key, (modifiers & GLFW_MOD_CONTROL) != 0);
    if (app == nullptr) return;
    if (event == GLFW_RELEASE) {
      // Whatever was held by this key ends, with or without Control now.
      for (const KeyBinding& b : keyBindings()) {
        if (b.key == key) app->release(b.action);
      }
    } else if (binding != nullptr && (event == GLFW_PRESS || binding->habit == Habit::repeats)) {
      app->press(binding->action);
    }
  });
  glfwSetCursorPosCallback(state_->window, [](GLFWwindow* w, double x, double y) {
    if (State::of(w).app != nullptr) State::of(w).app->moveMouse(State::of(w).toPixels(x, y));
  });
  glfwSetMouseButtonCallback(state_->window, [](GLFWwindow* w, int button, int event, int) {
    App* app = State::of(w).app;
    if (app == nullptr || button > GLFW_MOUSE_BUTTON_RIGHT) return;
    const MouseButton which = button == GLFW_MOUSE_BUTTON_LEFT ? MouseButton::left : MouseButton::right;
    if (event == GLFW_PRESS) {
      app->pressMouse(which);
    } else {
      app->releaseMouse(which);
    }
  });
  glfwSetScrollCallback(state_->window, [](GLFWwindow* w, double, double y) {
    if (State::of(w).app != nullptr) State::of(w).app->wheel(y);
  });
  glfwSetWindowRefreshCallback(state_->window, [](GLFWwindow* w) {
    if (State::of(w).app != nullptr) State::of(w).app->redraw();
  });
  glfwSetWindowFocusCallback(state_->window, [](GLFWwindow* w, int focused) {
    if (State::of(w).app != nullptr && focused == GLFW_FALSE) State::of(w).app->releaseAll();
  });
  glfwSetDropCallback(state_->window, [](GLFWwindow* w, int count, const char** paths) {
    if (State::of(w).app != nullptr && count > 0) State::of(w).app->open(paths[0]);
  });
}

Window::~Window() {
  glfwDestroyWindow(state_->window);
  glfwTerminate();
}

void Window::setListener(App* app) {
  state_->app = app;
}

void Window::pollEvents(double seconds) {
  if (seconds > 0.0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void Window::swapBuffers() {
  glfwSwapBuffers(state_->window);
}
bool Window::shouldClose() const {
  return glfwWindowShouldClose(state_->window) != 0;
}

glm::ivec2 Window::framebufferSize() const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(state_->window, &size.x, &size.y);
  return size;
}

float Window::scale() const {
  float x = 1.0f;
  float y = 1.0f;
  glfwGetWindowContentScale(state_->window, &x, &y);
  return x;
}

void Window::setTitle(const std::string& title) {
  if (title == state_->title) return;
  state_->title = title;
  glfwSetWindowTitle(state_->window, title.c_str());
}

void Window::toggleFullScreen() {
  if (glfwGetWindowMonitor(state_->window) != nullptr) {
    glfwSetWindowMonitor(state_->window, nullptr, state_->windowedAt.x, state_->windowedAt.y, state_->windowedSize.x,
                         state_->windowedSize.y, GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return;
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  glfwGetWindowPos(state_->window, &state_->windowedAt.x, &state_->windowedAt.y);
  glfwGetWindowSize(state_->window, &state_->windowedSize.x, &state_->windowedSize.y);
  glfwSetWindowMonitor(state_->window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

}  // namespace gnomon
