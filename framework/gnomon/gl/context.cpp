#include "gnomon/gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <string_view>

#include "gnomon/base/error.h"
#include "gnomon/base/log.h"

namespace gnomon::gl {

ContextInfo currentContextInfo() {
  const auto text = [](GLenum name) {
    const GLubyte* s = glGetString(name);
    return s == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(s));
  };
  return {text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION)};
}

// --- debug messages -----------------------------------------------------------------------------------------------------

namespace {

struct Gathered {
  int users = 0;
  std::string errors;
  void* earlierFunction = nullptr;  // who received before the first: gets them again after the last
  void* earlierUser = nullptr;
};
thread_local Gathered gathered;

constexpr std::size_t kMostText = 2000;

void gather(const std::string& message) {
  if (gathered.errors.size() < kMostText) gathered.errors += (gathered.errors.empty() ? "" : "; ") + message;
}

/// Exceptions must not cross the driver: the message waits for throwIfError.
void GLAPIENTRY receive(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei length, const GLchar* text,
                        const void* /*user*/) {
  const std::string message(text, length < 0 ? std::strlen(text) : static_cast<std::size_t>(length));
  if (type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) {
    gather(message);
  } else if (severity == GL_DEBUG_SEVERITY_HIGH) {
    log::warning("OpenGL: " + message);
  }
}

/// Empties the context's error flags; the first of them, or GL_NO_ERROR.
GLenum takeErrorFlag() {
  const GLenum first = glGetError();
  for (int i = 0; first != GL_NO_ERROR && i < 16 && glGetError() != GL_NO_ERROR; ++i) continue;  // one flag for each unit
  return first;
}

}  // namespace

DebugMessages::DebugMessages() {
  if (gathered.users++ == 0) {
    gathered.errors.clear();
    glGetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &gathered.earlierFunction);
    glGetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &gathered.earlierUser);
  }
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
  glDebugMessageCallback(&receive, nullptr);
}

DebugMessages::~DebugMessages() {
  if (--gathered.users == 0)
    glDebugMessageCallback(reinterpret_cast<GLDEBUGPROC>(gathered.earlierFunction), gathered.earlierUser);
}

void DebugMessages::throwIfError(const std::string& where) {
  const GLenum flag = takeErrorFlag();
  if (gathered.errors.empty() && flag != GL_NO_ERROR) gather(fmt::format("error 0x{:04x}", static_cast<unsigned>(flag)));
  if (gathered.errors.empty()) return;
  const std::string message = where + ": OpenGL: " + gathered.errors;
  gathered.errors.clear();
  throw Error(message);
}

void DebugMessages::discard() {
  discardMessages();
}

void discardMessages() {
  takeErrorFlag();
  gathered.errors.clear();
}

// --- EGL ----------------------------------------------------------------------------------------------------------------

struct HeadlessContext::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

bool hasExtension(const char* list, std::string_view name) {
  return list != nullptr && std::string_view(list).find(name) != std::string_view::npos;
}

std::vector<EGLDeviceEXT> hardwareDevices() {
  if (!hasExtension(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_device_enumeration")) return {};
  std::array<EGLDeviceEXT, 32> all{};
  EGLint count = 0;
  if (eglQueryDevicesEXT(static_cast<EGLint>(all.size()), all.data(), &count) == EGL_FALSE) return {};
  std::vector<EGLDeviceEXT> hardware;
  for (EGLint i = 0; i < count; ++i) {
    EGLDeviceEXT device = all[static_cast<std::size_t>(i)];
    if (!hasExtension(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software")) hardware.push_back(device);
  }
  return hardware;
}

std::string eglErrorText() {
  return fmt::format("EGL error 0x{:04x}", static_cast<unsigned>(eglGetError()));
}

/// An empty text on success, else why not.
std::string tryCreate(EGLDisplay display, bool debug, EGLContext& context) {
  EGLint major = 0;
  EGLint minor = 0;
  if (display == EGL_NO_DISPLAY) return "no display";
  if (eglInitialize(display, &major, &minor) == EGL_FALSE) return "eglInitialize failed, " + eglErrorText();
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return "no desktop OpenGL, " + eglErrorText();
  const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                         4,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         5,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_CONTEXT_OPENGL_DEBUG,
                                         debug ? EGL_TRUE : EGL_FALSE,
                                         EGL_NONE};
  context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return "no OpenGL 4.5 core context, " + eglErrorText();
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
    eglDestroyContext(display, context);
    return "cannot be current without a surface, " + eglErrorText();
  }
  return {};
}

}  // namespace

HeadlessContext::HeadlessContext(const HeadlessOptions& options) : state_(std::make_unique<State>()) {
  const std::vector<EGLDeviceEXT> devices = hardwareDevices();
  if (options.gpu >= static_cast<int>(devices.size())) {
    throw Error(
        fmt::format("--gpu {}: EGL finds {} hardware device(s); leave --gpu out to take the first, or software rendering",
                    options.gpu, devices.size()));
  }
  std::string tried;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (options.gpu >= 0 && i != static_cast<std::size_t>(options.gpu)) continue;
    state_->display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    const std::string why = tryCreate(state_->display, options.debug, state_->context);
    if (why.empty()) return;
    tried += fmt::format(" GPU {}: {}.", i, why);
  }
  if (options.gpu < 0) {
    state_->display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    const std::string why = tryCreate(state_->display, options.debug, state_->context);
    if (why.empty()) return;
    tried += fmt::format(" Surfaceless software rendering: {}.", why);
  }
  throw Error("no OpenGL 4.5 core context without a window." + tried +
              " Install a GPU driver with EGL, or Mesa's software renderer (Debian: libegl-mesa0, libgl1-mesa-dri).");
}

HeadlessContext::~HeadlessContext() {
  eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(state_->display, state_->context);
  // The display stays initialised: terminating it unloads the driver, which other contexts and leak checkers still need.
}

}  // namespace gnomon::gl
