// Renders nothing: it refuses, and says which version of the library it is of and how many its static variables counted.
#include <gnomon/plugin.h>

#include <string>

namespace gnomon {

/// Exported and inline: the kind of static variable that a compiler may make one for the whole process.
__attribute__((visibility("default"))) inline int& exportedCount() {
  static int count = 0;
  return count;
}

namespace {

int ownCount = 0;

struct Parameters {};

class Generation final : public Technique {
 public:
  explicit Generation(const Parameters& /*parameters*/) : own_(++ownCount), exported_(++exportedCount()) {}

  Support support(const SceneSurvey& /*survey*/, const Light& /*light*/, const Frame& /*frame*/) const override {
    return Support::refused(GENERATION " " + std::to_string(own_) + " " + std::to_string(exported_));
  }
  Outputs setup(GraphBuilder& /*graph*/, const Frame& /*frame*/, const EffectPlan& /*plan*/) override { return {}; }

 private:
  int own_, exported_;
};

}  // namespace
}  // namespace gnomon

GNOMON_PLUGIN(gnomon::entry<gnomon::Generation>("generation", gnomon::ParameterTable<gnomon::Parameters>{}, {}))
