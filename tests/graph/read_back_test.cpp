// What cpu passes read back is copied again only when it has changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "bench.h"
#include "gl_calls.h"
#include "gnomon/base/error.h"

namespace gnomon::test {
namespace {

using testing::Each;

/// "look" copies the target of "draw" on the CPU whenever the camera moves; "draw" shows `value`, which follows the light.
class ReadBacks : public testing::Test {
 protected:
  ReadBacks() {
    GraphBuilder& builder = graph_->builder();
    const Buffer numbers = builder.buffer("numbers", 16);
    builder.cpu("fit", {.inputs = {Input::light}, .buffers = {numbers}, .run = [this, numbers](CpuContext& context) {
                          context.writeBlock(numbers, std::array<float, 4>{value, 0, 0, 0});
                        }});
    const Texture drawn =
        builder.fullscreen("draw", {.shader = shaderWriting(builder, "x", "layout(std140) uniform Numbers { float x; };"),
                                    .buffers = {{"Numbers", numbers}}});
    copy_ = builder.texture("copy", {{8, 4}, Format::r32f});
    builder.cpu("look",
                {.inputs = {Input::camera}, .reads = {drawn}, .writes = {copy_}, .run = [this, drawn](CpuContext& context) {
                   context.write(copy_, context.read(drawn));
                   if (broken) throw Error("no luck");
                 }});
    graph_->compile(std::span(&copy_, 1));
    bench_.run(*graph_);
  }

  /// Textures read while a frame runs after the camera moved.
  int readsOfAFrame(const GraphRun& options = {}) {
    ++bench_.revisions[Input::camera];
    const ReadTextures reads;
    bench_.run(*graph_, options);
    return reads.count();
  }

  float value = 1.0f;
  bool broken = false;
  Bench bench_;
  std::unique_ptr<Graph> graph_ = bench_.graph();
  Texture copy_;
};

TEST_F(ReadBacks, AreKeptWhileTheTextureStays) {
  EXPECT_EQ(readsOfAFrame(), 0);
  EXPECT_THAT(graph_->read(copy_).data, Each(1.0f));
}

TEST_F(ReadBacks, AreMadeAgainWhenItChanged) {
  value = 2.0f;
  ++bench_.revisions[Input::light];
  EXPECT_EQ(readsOfAFrame(), 1);
  EXPECT_THAT(graph_->read(copy_).data, Each(2.0f));
}

TEST_F(ReadBacks, AreMadeAgainWhereNothingIsSkipped) {
  EXPECT_EQ(readsOfAFrame({.skipUnchanged = false}), 1);
}

TEST_F(ReadBacks, AreMadeAgainAfterAFailure) {
  broken = true;
  EXPECT_THROW(readsOfAFrame(), Error);
  broken = false;
  EXPECT_EQ(readsOfAFrame(), 1);
}

}  // namespace
}  // namespace gnomon::test
