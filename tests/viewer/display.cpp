#include "display.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"

namespace gnomon::test {

namespace {

/// Starts a program with nothing of this process but its environment; `prepare` runs in the child.
template <class Prepare>
pid_t start(const std::vector<std::string>& words, const Prepare& prepare) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = fork();  // no OpenGL has been touched in this process
  if (child < 0) throw Error("no process can be started");
  if (child == 0) {
    prepare();
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  return child;
}

void sendAllTo(const std::filesystem::path& file) {
  const int out = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
}

}  // namespace

void sleepMilliseconds(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

Display::Display(int dpi) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("no pipe");
  server_ = start({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1280x1024x24", "-nolisten", "tcp",
                   "-noreset"},  // else it starts over, and refuses who comes meanwhile, whenever its last client leaves
                  [&] {
                    close(ends[0]);
                    sendAllTo("/dev/null");
                  });
  close(ends[1]);
  char c = 0;
  while (read(ends[0], &c, 1) == 1 && c != '\n') name_ += c;  // the server says which display it took
  close(ends[0]);
  if (name_.empty()) throw Error("Xvfb did not start; scripts/setup installs it");
  name_ = ":" + name_;
  if (dpi == 96) return;
  // As desktops do it: the resource that programs ask for.
  const std::vector<std::string> words{
      "xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER", "Xft.dpi:\t" + std::to_string(dpi) + "\n"};
  const pid_t child = start(words, [&] { setenv("DISPLAY", name_.c_str(), 1); });
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw Error("xprop could not set the screen's density; scripts/setup installs it");
}

Display::~Display() {
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

Viewer::Viewer(const std::string& display, const std::filesystem::path& folder, const std::vector<std::string>& arguments)
    : display_(display), log_(folder / "viewer.log"), frameLog_(folder / "frames.jsonl") {
  std::vector<std::string> words{std::string(GNOMON_BINARY_DIR) + "/bin/gnomon-view", "--frame-log", frameLog_.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  child_ = start(words, [&] {
    if (chdir(folder.c_str()) != 0) _exit(126);
    if (display.empty()) {
      unsetenv("DISPLAY");
      unsetenv("WAYLAND_DISPLAY");
    } else {
      setenv("DISPLAY", display.c_str(), 1);
    }
    sendAllTo(log_);
  });
}

Viewer::~Viewer() {
  if (!running()) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

bool Viewer::running() {
  if (!ended_ && waitpid(child_, &status_, WNOHANG) == child_) ended_ = true;
  return !ended_;
}

int Viewer::exitCode() {
  for (int i = 0; i < 600 && running(); ++i) sleepMilliseconds(100);
  if (!ended_) return -1;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

std::string Viewer::errors() const {
  return readFile(log_);
}

std::vector<Json> Viewer::frames() const {
  std::vector<Json> all;
  std::ifstream in(frameLog_);
  for (std::string line; std::getline(in, line) && !in.eof();) all.push_back(Json::parse(line));  // the last may be half a line
  return all;
}

Json Viewer::lastFrame() const {
  const std::vector<Json> all = frames();
  return all.empty() ? Json() : all.back();
}

bool Viewer::untilFrame(const std::function<bool(const Json&)>& wanted) const {
  return eventually([&] {
    const Json last = lastFrame();
    return !last.is_null() && wanted(last);
  });
}

void Viewer::keys(const std::vector<std::string>& names) const {
  std::vector<std::string> words{"key", "--delay", "150"};
  words.insert(words.end(), names.begin(), names.end());
  xdotool({{"search", "--onlyvisible", "--name", "Gnomon: ", "windowfocus"}, words});
}

void Viewer::xdotool(const std::vector<std::vector<std::string>>& commands) const {
  for (const auto& command : commands) {
    if (!tool(command)) throw Error("xdotool could not " + command.at(0));
  }
}

bool Viewer::tool(std::vector<std::string> words) const {
  words.insert(words.begin(), "xdotool");
  const pid_t child = start(words, [&] {
    setenv("DISPLAY", display_.c_str(), 1);
    sendAllTo("/dev/null");
  });
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void Viewer::waitForWindow() const {
  // The first frame, not only the window: keys that come before it find nobody listening.
  const auto there = [&] { return tool({"search", "--onlyvisible", "--name", "Gnomon: "}) && !lastFrame().is_null(); };
  if (!eventually(there)) throw Error("the viewer's window does not come: " + errors());
}

}  // namespace gnomon::test
