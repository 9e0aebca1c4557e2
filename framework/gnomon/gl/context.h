// A headless OpenGL 4.5 core context through EGL, and the debug messages of any context as our errors.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace gnomon::gl {

/// What the driver says of itself. Recorded in results; no decision is made by these strings.
struct ContextInfo {
  std::string vendor, renderer, version;
};
ContextInfo currentContextInfo();

/// Forgets what DebugMessages have gathered: for who tells of a fault in words of its own, such as a shader that does not
/// compile.
void discardMessages();

/// What the driver calls an error, gathered for this thread while any of these lives; they share what was gathered, in any
/// order of making and ending. The current context's messages come here from when one was made. Drivers whose contexts tell
/// nothing unless made for debugging are asked by glGetError.
class DebugMessages {
 public:
  DebugMessages();
  ~DebugMessages();
  DebugMessages(const DebugMessages&) = delete;
  DebugMessages& operator=(const DebugMessages&) = delete;

  /// Throws Error with everything the driver called an error since the last call; `where` says what was running.
  void throwIfError(const std::string& where);
  /// Forgets them: whoever made them has failed already, and who comes next is not to blame.
  void discard();
};

struct HeadlessOptions {
  int gpu = -1;        ///< index among the EGL devices that are hardware; -1: the first, or software where there is none
  bool debug = false;  ///< a debug context: slower, says more
};

/// Current on the calling thread until destroyed. Throws Error that says what was tried when no OpenGL 4.5 is to be had.
class HeadlessContext {
 public:
  explicit HeadlessContext(const HeadlessOptions& options = {});
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gnomon::gl
