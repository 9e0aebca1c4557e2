#include "gnomon/gl/state.h"

#include <epoxy/gl.h>

#include <initializer_list>

namespace gnomon::gl {

namespace {

void restoreSwitches() {
  for (const GLenum off : {GL_BLEND,
                           GL_COLOR_LOGIC_OP,
                           GL_CULL_FACE,
                           GL_DEPTH_CLAMP,
                           GL_DEPTH_TEST,
                           GL_FRAMEBUFFER_SRGB,
                           GL_LINE_SMOOTH,
                           GL_POLYGON_OFFSET_FILL,
                           GL_POLYGON_OFFSET_LINE,
                           GL_POLYGON_OFFSET_POINT,
                           GL_POLYGON_SMOOTH,
                           GL_PRIMITIVE_RESTART,
                           GL_PRIMITIVE_RESTART_FIXED_INDEX,
                           GL_PROGRAM_POINT_SIZE,
                           GL_RASTERIZER_DISCARD,
                           GL_SAMPLE_ALPHA_TO_COVERAGE,
                           GL_SAMPLE_ALPHA_TO_ONE,
                           GL_SAMPLE_COVERAGE,
                           GL_SAMPLE_MASK,
                           GL_SAMPLE_SHADING,
                           GL_SCISSOR_TEST,
                           GL_STENCIL_TEST})
    glDisable(off);
  for (const GLenum plane : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U}) glDisable(GL_CLIP_DISTANCE0 + plane);
  glEnable(GL_DITHER);
  glEnable(GL_MULTISAMPLE);
}

void restoreRasterising() {
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ZERO);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDepthRange(0.0, 1.0);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glStencilFunc(GL_ALWAYS, 0, ~0U);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glStencilMask(~0U);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glLogicOp(GL_COPY);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glPolygonOffset(0.0f, 0.0f);
  glBlendColor(0.0f, 0.0f, 0.0f, 0.0f);
  glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
  glPrimitiveRestartIndex(0);
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glPointSize(1.0f);
  glMinSampleShading(0.0f);
  glSampleMaski(0, ~0U);
  glSampleCoverage(1.0f, GL_FALSE);
  glClampColor(GL_CLAMP_READ_COLOR, GL_FIXED_ONLY);
}

/// What encloses drawing until it is ended. Nothing tells whether a conditional rendering is under way, so that ending one is
/// tried, unheard.
void endEnclosures() {
  GLboolean feedback = GL_FALSE;
  glGetBooleanv(GL_TRANSFORM_FEEDBACK_BUFFER_ACTIVE, &feedback);
  if (feedback == GL_TRUE) glEndTransformFeedback();
  glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
  const GLboolean heard = glIsEnabled(GL_DEBUG_OUTPUT);
  glDisable(GL_DEBUG_OUTPUT);
  glEndConditionalRender();
  while (glGetError() != GL_NO_ERROR) {
  }
  if (heard == GL_TRUE) glEnable(GL_DEBUG_OUTPUT);
}

}  // namespace

void restoreTransfers() {
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  for (const GLenum alignment : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(alignment, 4);
  for (const GLenum none :
       {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH, GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS,
        GL_PACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT,
        GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES})
    glPixelStorei(none, 0);
}

void restoreState() {
  endEnclosures();
  restoreSwitches();
  restoreRasterising();
  restoreTransfers();
}

}  // namespace gnomon::gl
