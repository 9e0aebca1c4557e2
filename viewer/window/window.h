// One GLFW window with an OpenGL 4.5 core context, current on this thread.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>

namespace gnomon {

class App;

class Window {
 public:
  /// Throws Error when there is no display or no OpenGL 4.5, and says that the headless runner needs neither.
  Window(const std::string& title, glm::ivec2 size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Who gets keys, mouse and dropped files from now on.
  void setListener(App* app);
  /// Handles what has happened; waits up to `seconds` for something to happen.
  void pollEvents(double seconds);
  void swapBuffers();
  bool shouldClose() const;
  glm::ivec2 framebufferSize() const;
  /// Framebuffer pixels for each unit of the screen, by which text grows.
  float scale() const;
  void setTitle(const std::string& title);
  void toggleFullScreen();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gnomon
