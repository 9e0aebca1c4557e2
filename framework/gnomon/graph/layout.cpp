// Layout: which passes are kept, which are shared with other graphs, and where
// textures lie.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/graph/identity.h"
#include "gnomon/graph/state.h"

namespace gnomon {

namespace {

/// First and last pass, by index, between which a texture must keep its
/// contents.
struct Lifetime {
  std::size_t first = 0;
  std::size_t last = 0;
};

GLenum depthAttachment(Format format) {
  return format == Format::d32f_s8 ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
}

class Layout {
 public:
  explicit Layout(Graph::State& state) : s_(state) {}

  void run() {
    prune();
    share();
    placeTransient();
    placeOthers();
    for (PassNode& node : s_.passes) {
      if (node.kept) attach(node);
    }
    findRemakes();
    fillReport();
  }

 private:
  /// Backwards from the outputs: a pass is kept if something kept reads what it
  /// writes. Histories are read before they are written: again, until nothing
  /// is added.
  void prune() {
    std::set<int> textures;
    std::set<int> buffers;
    for (const Texture output : s_.outputs) textures.insert(output.id);
    std::vector<bool> kept(s_.passes.size(), false);
    for (bool added = true; added;) {
      added = false;
      for (std::size_t i = s_.passes.size(); i-- > 0;) {
        const PassNode& node = s_.passes[i];
        const auto writesTexture = [&](const Target& t) { return textures.contains(t.texture.id); };
        const auto writesBuffer = [&](Buffer b) { return buffers.contains(b.id); };
        if (kept[i] || (std::none_of(node.writes.begin(), node.writes.end(), writesTexture) &&
                        std::none_of(node.bufferWrites.begin(), node.bufferWrites.end(), writesBuffer))) {
          continue;
        }
        kept[i] = added = true;
        for (const Texture read : node.textureReads) textures.insert(read.id);
        for (const Buffer read : node.bufferReads) buffers.insert(read.id);
      }
    }
    for (std::size_t i = 0; i < s_.passes.size(); ++i) {
      PassNode& node = s_.passes[i];
      if (node.kept && !kept[i]) drop(node);
      node.kept = kept[i];
    }
    for (const int id : textures) {
      const TextureSlot& slot = s_.at(Texture{id});
      if (slot.isHistory && slot.writers[0] < 0) {
        throw Error(
            fmt::format("graph '{}': history '{}' is read, and nothing is remembered in it", s_.name, slot.resource->name));
      }
    }
  }

  /// What it made is given up; kept again, it starts as if new.
  void drop(PassNode& node) {
    node.memory = std::make_shared<PassMemory>();
    node.framebuffer = {};
    node.attached.clear();
    if (node.shared) unshare(node);
    for (const Target& target : node.writes) s_.texture(target.texture).object = {};
  }

  // --- sharing ---

  void share() {
    if (!s_.shares.passes) return;
    SharedPasses& pool = *s_.shares.passes;
    std::erase_if(pool.byIdentity, [](const auto& entry) { return entry.second.expired(); });
    for (PassNode& node : s_.passes) {
      if (!node.kept) continue;
      const std::string identity = identityOf(s_, node);
      if (node.shared ? node.shared->identity == identity : identity.empty()) continue;
      if (identity.empty()) {
        unshare(node);
        continue;
      }
      auto& entry = pool.byIdentity[identity];
      if (const auto other = entry.lock()) {
        if (node.shared) unshare(node);
        adopt(node, other);
      } else if (node.shared.use_count() == 1) {  // nobody else's: another name for what it has already
        pool.byIdentity.erase(node.shared->identity);
        node.shared->identity = identity;
        node.shared->memory = node.memory;
        entry = node.shared;
      } else {
        if (node.shared) unshare(node);
        node.shared = offer(node, identity, ++pool.made);
        entry = node.shared;
      }
    }
  }

  std::shared_ptr<SharedPass> offer(const PassNode& node, const std::string& identity, std::uint64_t serial) const {
    auto shared = std::make_shared<SharedPass>();
    shared->serial = serial;
    shared->identity = identity;
    shared->memory = node.memory;
    for (const Target& target : node.writes) shared->textures.push_back(s_.at(target.texture).resource);
    for (const Buffer buffer : node.bufferWrites) shared->buffers.push_back(s_.at(buffer).resource);
    if (const auto* cpu = std::get_if<CpuPass>(&node.kind)) {
      for (const DrawList list : cpu->draws) shared->draws.push_back(listOf(list).storage);
    }
    return shared;
  }

  /// A cpu pass keeps its own memory: it runs in each graph, whose facts it
  /// fills, and equal bytes are no change.
  void adopt(PassNode& node, const std::shared_ptr<SharedPass>& shared) {
    node.shared = shared;
    for (std::size_t i = 0; i < node.writes.size(); ++i) s_.at(node.writes[i].texture).resource = shared->textures[i];
    for (std::size_t i = 0; i < node.bufferWrites.size(); ++i) s_.at(node.bufferWrites[i]).resource = shared->buffers[i];
    if (const auto* cpu = std::get_if<CpuPass>(&node.kind)) {
      for (std::size_t i = 0; i < cpu->draws.size(); ++i) listOf(cpu->draws[i]).storage = shared->draws[i];
    } else {
      node.memory = shared->memory;
    }
  }

  /// Targets of its own again, empty.
  void unshare(PassNode& node) {
    node.shared.reset();
    node.memory = std::make_shared<PassMemory>();
    for (const Target& target : node.writes) {
      auto fresh = std::make_shared<TextureResource>();
      fresh->name = s_.texture(target.texture).name;
      fresh->info = s_.texture(target.texture).info;
      s_.at(target.texture).resource = std::move(fresh);
    }
    for (const Buffer buffer : node.bufferWrites) {
      auto fresh = std::make_shared<BufferResource>();
      fresh->name = s_.buffer(buffer).name;
      fresh->revision = nextRevision();
      if (!isRecords(buffer)) {
        fresh->bytes = s_.buffer(buffer).bytes;
        fresh->object = gl::makeBuffer(fresh->bytes, nullptr, s_.name + "/" + fresh->name);
        glClearNamedBufferData(fresh->object.name(), GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
      }
      s_.at(buffer).resource = std::move(fresh);
    }
    if (const auto* cpu = std::get_if<CpuPass>(&node.kind)) {
      for (const DrawList list : cpu->draws) listOf(list).storage = std::make_shared<DrawStorage>();
    }
  }

  DrawListState& listOf(DrawList list) const { return s_.drawLists[static_cast<std::size_t>(list.id)]; }
  bool isRecords(Buffer buffer) const {
    return std::any_of(s_.drawLists.begin(), s_.drawLists.end(), [&](const auto& list) { return list.records == buffer; });
  }

  // --- places ---

  bool isTransient(Texture texture) const { return s_.texture(texture).info.transient; }

  /// Each transient texture takes the first memory of its kind whose last
  /// texture nobody reads any more. Nothing is moved that lies as it should
  /// already.
  void placeTransient() {
    struct Place {
      TextureInfo info;
      std::size_t last = 0;
      std::vector<TextureResource*> textures;
    };
    std::vector<Place> places;
    for (const auto& [id, lifetime] : lifetimes()) {
      TextureResource& resource = s_.texture(Texture{id});
      const auto fits = [&, life = lifetime](const Place& place) {
        return place.last < life.first && place.info.size == resource.info.size && place.info.format == resource.info.format &&
               place.info.layers == resource.info.layers;
      };
      auto place = std::find_if(places.begin(), places.end(), fits);
      if (place == places.end()) place = places.insert(places.end(), Place{resource.info, 0, {}});
      place->last = lifetime.last;
      place->textures.push_back(&resource);
    }
    for (const Place& place : places) {
      const TextureMemory& first = place.textures[0]->object;
      const bool asBefore =
          first &&
          std::all_of(place.textures.begin(), place.textures.end(), [&](const auto* t) { return t->object == first; }) &&
          usersOf(first) == place.textures.size();
      if (asBefore) continue;
      std::string label = s_.name + "/";
      for (const TextureResource* texture : place.textures) label += (texture == place.textures[0] ? "" : ", ") + texture->name;
      const TextureMemory memory = allocate(place.info, label);
      for (TextureResource* texture : place.textures) texture->object = memory;
    }
  }

  std::size_t usersOf(const TextureMemory& memory) const {
    return static_cast<std::size_t>(std::count_if(s_.textures.begin(), s_.textures.end(),
                                                  [&](const TextureSlot& slot) { return slot.resource->object == memory; }));
  }

  /// Of transient textures of kept passes, in the order in which they are first
  /// written.
  std::vector<std::pair<int, Lifetime>> lifetimes() const {
    std::vector<std::pair<int, Lifetime>> all;
    const auto find = [&](Texture texture) {
      return std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.first == texture.id; });
    };
    for (std::size_t i = 0; i < s_.passes.size(); ++i) {
      const PassNode& node = s_.passes[i];
      if (!node.kept) continue;
      for (const Target& target : node.writes) {
        if (!isTransient(target.texture)) continue;
        if (const auto known = find(target.texture); known != all.end()) {
          known->second.last = i;
        } else {
          all.emplace_back(target.texture.id, Lifetime{i, i});
        }
      }
      for (const Texture read : node.textureReads) {
        if (const auto known = find(read); known != all.end()) known->second.last = i;
      }
    }
    return all;
  }

  void placeOthers() {
    for (const PassNode& node : s_.passes) {
      if (!node.kept) continue;
      for (const Target& target : node.writes) {
        const TextureSlot& slot = s_.at(target.texture);
        if (slot.resource->object) continue;
        slot.resource->object = allocate(slot.resource->info, s_.name + "/" + slot.resource->name);
        if (!slot.isHistory) continue;
        clearTexture(*slot.resource, slot.reset);
        slot.resource->revision = nextRevision();
      }
    }
  }

  static TextureMemory allocate(const TextureInfo& info, const std::string& label) {
    const GLenum format = formatFacts(info.format).internalFormat;
    return info.layers > 0 ? gl::makeTexture2DArray(format, info.size, info.layers, label)
                           : gl::makeTexture2D(format, info.size, label);
  }

  // --- framebuffers ---

  void attach(PassNode& node) const {
    std::vector<Target> targets = node.writes;
    if (const auto* raster = std::get_if<RasterPass>(&node.kind)) {
      if (raster->depthRead) targets.push_back({*raster->depthRead, raster->layer.value_or(-1)});
    } else if (const auto* screen = std::get_if<FullscreenPass>(&node.kind)) {
      if (screen->stencil) targets.push_back({screen->stencil->texture, -1});
    } else {
      return;
    }
    std::vector<GLuint> wanted;
    for (const Target& target : targets) wanted.push_back(s_.texture(target.texture).object.name());
    if (node.framebuffer && node.attached == wanted) return;

    node.framebuffer = gl::makeFramebuffer(s_.name + "/" + node.name);
    const GLuint name = node.framebuffer.name();
    std::vector<GLenum> draws;
    for (const Target& target : targets) {
      const TextureResource& resource = s_.texture(target.texture);
      const bool depth = formatFacts(resource.info.format).depth;
      const GLenum attachment =
          depth ? depthAttachment(resource.info.format) : GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draws.size());
      if (target.layer >= 0 && resource.info.layers > 0) {
        glNamedFramebufferTextureLayer(name, attachment, resource.object.name(), 0, target.layer);
      } else {
        glNamedFramebufferTexture(name, attachment, resource.object.name(), 0);
      }
      if (!depth) draws.push_back(attachment);
    }
    if (draws.empty()) draws.push_back(GL_NONE);
    glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(draws.size()), draws.data());
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
      throw Error(
          fmt::format("pass '{}': its targets of {}x{} are not a complete framebuffer here (0x{:04x}); a smaller size may "
                      "fit this driver's memory",
                      node.name, node.size.x, node.size.y, status));
    }
    node.attached = std::move(wanted);
  }

  // --- what skipping must know ---

  /// Writers of the transient textures that a pass reads, and of those that
  /// these read.
  void findRemakes() {
    for (PassNode& node : s_.passes) {
      std::set<std::size_t> all;
      for (const Texture read : node.textureReads) {
        if (!isTransient(read)) continue;
        for (const int writer : s_.at(read).writers) {
          const auto index = static_cast<std::size_t>(writer);
          all.insert(index);
          all.insert(s_.passes[index].remakes.begin(), s_.passes[index].remakes.end());
        }
      }
      node.remakes.assign(all.begin(), all.end());
    }
  }

  void fillReport() {
    s_.report.passes.clear();
    for (PassNode& node : s_.passes) {
      node.report = s_.report.passes.size();
      if (node.kept) s_.report.passes.push_back({node.name});
    }
  }

  Graph::State& s_;
};

}  // namespace

void layOut(Graph::State& state) {
  Layout(state).run();
}

std::shared_ptr<SharedPasses> makeSharedPasses() {
  return std::make_shared<SharedPasses>();
}

}  // namespace gnomon
