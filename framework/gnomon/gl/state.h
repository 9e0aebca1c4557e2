// OpenGL's state, where code that is not ours may have changed it.
#pragma once

namespace gnomon::gl {

/// Sets all state back to OpenGL's defaults that could change what the framework draws, clears, reads or uploads, and that it
/// does not set for each pass anyway. Bindings of programs, vertex arrays, framebuffers and textures are not among it.
void restoreState();

/// That part of it which decides how pixels are read into memory, and written from it.
void restoreTransfers();

}  // namespace gnomon::gl
