#include "bench.h"

#include <fmt/format.h>

#include <glm/ext/matrix_transform.hpp>

#include "gnomon/base/files.h"
#include "gnomon/scene/builtin.h"

namespace gnomon::test {

Bench::Bench() {
  ensureContext();
  messages_ = std::make_unique<gl::DebugMessages>();
  scene.meshes = {quadMesh(2.0, 2.0), boxMesh(glm::dvec3(0.5))};
  scene.materials = {{}};
  scene.instances = {{"floor", 0, 0, glm::dmat4(1.0), false, true},
                     {"box", 1, 0, glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}), true, true}};
  for (const Instance& instance : scene.instances) bounds.push_back(worldBounds(scene, instance));
  light.position = {1.0, 5.0, 0.5};
  camera.position = {0.0, 5.0, 5.0};
  gpu_ = std::make_unique<GpuScene>(scene);
}

std::unique_ptr<Graph> Bench::graph(const std::string& name, glm::ivec2 size) const {
  return std::make_unique<Graph>(name, size, gl::ShaderSources{{installationDirectory() / "shaders"}, {}});
}

FrameInputs Bench::inputs() const {
  return {scene, bounds, *gpu_, light, camera, {8, 4}, 0.0};
}

GraphReport Bench::run(Graph& graph, GraphRun options) {
  options.messages = messages_.get();
  return graph.run(inputs(), revisions, options);
}

std::vector<std::string> ran(const GraphReport& report) {
  std::vector<std::string> names;
  for (const PassReport& pass : report.passes) {
    if (pass.ran) names.push_back(pass.name);
  }
  return names;
}

bool besideAnEdge(const Image& image, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (image.at(x + dx, y + dy) != image.at(x, y)) return true;
    }
  }
  return false;
}

std::string shaderWriting(GraphBuilder& graph, const std::string& expression, const std::string& declarations) {
  const std::string text =
      fmt::format("{}\nout float result;\nvoid main() {{ const ivec2 p = ivec2(gl_FragCoord.xy); result = {}; }}\n",
                  declarations, expression);
  const std::string name = fmt::format("test {:x}", std::hash<std::string>{}(text));
  graph.include(name, text);
  return name;
}

}  // namespace gnomon::test
