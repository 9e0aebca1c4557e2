// What the viewer looks at: a run config, or a scene file with every registered technique.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/measure/error.h"
#include "gnomon/run/resolve.h"

namespace gnomon {

/// A technique that can be flipped to.
struct ViewerTechnique {
  ResolvedTechnique technique = {};        ///< with what keys have changed
  ResolvedTechnique asWritten = {};        ///< as the files say
  std::optional<ErrorFigures> error = {};  ///< for this view
  int errorSamples = 0;                    ///< of the reference, when it was measured

  /// Something moved or changed.
  void forgetError() {
    error.reset();
    errorSamples = 0;
  }
};

struct Document {
  std::filesystem::path subject;
  std::size_t scene = 0;  ///< which of the config's scenes
  std::size_t scenes = 1;
  std::shared_ptr<Registry> registry;
  ResolvedRun run;
  std::vector<ViewerTechnique> techniques;
  std::vector<NamedCamera> cameras;  ///< the config's, then the scene's
  std::string sceneHash;

  /// Files whose change matters beside the technique folders.
  std::vector<std::filesystem::path> files() const;
};

/// `subject` is a run config (.json), or a glTF file with all registered techniques. Throws InputError on faults in it, also
/// when `scene` is not one of the config's.
Document loadDocument(const std::filesystem::path& subject, std::size_t scene,
                      const std::vector<std::filesystem::path>& techniqueDirectories,
                      const std::shared_ptr<Libraries>& libraries);

/// The parameters that may be set by hand: a run config takes no seed of a reference, so keys change none.
std::vector<const Field*> editableFields(const ResolvedTechnique& technique);

/// {"technique": NAME, "parameters": {...}} with what differs from the technique's own values.
Json asConfigEntry(const ResolvedTechnique& technique);

/// Parameters that keys changed in `old` are changed in `fresh` too, where the technique still has them and takes the value.
void keepEdits(Document& fresh, const Document& old);

}  // namespace gnomon
