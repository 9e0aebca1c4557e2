// A graph with nothing around it: a small scene, a light, a camera, and revisions that the test raises itself.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gnomon/graph/graph.h"
#include "gnomon/scene/camera.h"
#include "gnomon/scene/light.h"
#include "gnomon/scene/scene.h"
#include "gnomon/session.h"
#include "render.h"

namespace gnomon::test {

class Bench {
 public:
  /// A floor and a box over it, seen from above.
  Bench();

  Scene scene;
  std::vector<Bounds> bounds;
  Light light;
  Camera camera;
  Revisions revisions;

  /// An empty graph over the framework's shaders. Shader texts are given by GraphBuilder::include.
  std::unique_ptr<Graph> graph(const std::string& name = "bench", glm::ivec2 size = {8, 4}) const;
  FrameInputs inputs() const;
  GraphReport run(Graph& graph, GraphRun options = {});

 private:
  std::unique_ptr<gl::DebugMessages> messages_;
  std::unique_ptr<GpuScene> gpu_;
};

/// Names of the passes that ran.
std::vector<std::string> ran(const GraphReport& report);

/// Whether one of the eight neighbours of an inner pixel has another value.
bool besideAnEdge(const Image& image, int x, int y);

/// The message of the Error that `action` throws, or "" if it throws none.
template <class Action>
std::string errorOf(const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

/// A full-screen shader that writes `expression` (float, may use `p`, the pixel), and its name for FullscreenPass::shader.
std::string shaderWriting(GraphBuilder& graph, const std::string& expression, const std::string& declarations = "");

}  // namespace gnomon::test
