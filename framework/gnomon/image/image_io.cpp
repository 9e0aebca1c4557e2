#include "gnomon/image/image_io.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/base/files.h"
#include "gnomon/image/image_module.h"

namespace gnomon {
namespace {

/// The module's functions. It stays loaded: its libraries start threads, which outlive a dlclose badly.
struct Module {
  GnomonImageWrite* write = nullptr;
  GnomonImageRead* read = nullptr;

  Module() {
    const std::filesystem::path path = installationDirectory() / "libgnomon_image.so";
    void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw Error(fmt::format("pictures cannot be read or written: {}", ::dlerror()));
    write = reinterpret_cast<GnomonImageWrite*>(::dlsym(library, kImageWriteSymbol));
    read = reinterpret_cast<GnomonImageRead*>(::dlsym(library, kImageReadSymbol));
    if (write == nullptr || read == nullptr)
      throw Error(fmt::format("{}: not the image module of this framework", path.string()));
  }
};

const Module& module() {
  static const Module loaded;  // a failed load is tried again at the next use
  return loaded;
}

using Message = std::array<char, 512>;

/// What the file shall hold, beside its name.
struct Content {
  int width, height, channels;
  const void* pixels;
  std::vector<const char*> channelNames = {};
  std::vector<const char*> attributeNames = {};
  std::vector<const char*> attributeValues = {};
};

void writePicture(const std::filesystem::path& path, const Content& content) {
  replaceFileAtomically(path, [&](const std::filesystem::path& temporary) {
    const GnomonImageSource source{temporary.c_str(),
                                   content.width,
                                   content.height,
                                   content.channels,
                                   content.channelNames.empty() ? nullptr : content.channelNames.data(),
                                   content.pixels,
                                   static_cast<int>(content.attributeNames.size()),
                                   content.attributeNames.data(),
                                   content.attributeValues.data()};
    Message message{};
    if (module().write(&source, message.data(), message.size()) != 0) {
      throw Error(fmt::format("{}: cannot write the picture: {}", path.string(), message.data()));
    }
  });
}

void requireExtension(const std::filesystem::path& path, const char* extension) {
  if (path.extension() != extension)
    throw Error(fmt::format("{}: the name of this picture must end in {}", path.string(), extension));
}

void requirePixels(const std::filesystem::path& path, const Image& image) {
  if (image.width < 1 || image.height < 1) throw Error(fmt::format("{}: the picture has no pixels", path.string()));
}

void requireChannels(const std::filesystem::path& path, const std::vector<NamedChannel>& channels) {
  if (channels.empty()) throw Error(fmt::format("{}: the picture has no channels", path.string()));
  std::set<std::string> names;
  for (const NamedChannel& channel : channels) {
    const Image& image = channel.image;
    const Image& first = channels.front().image;
    if (image.channels != 1 || image.width != first.width || image.height != first.height) {
      throw Error(fmt::format("{}: channel \"{}\" is {} x {} x {}; allowed: {} x {} x 1, as the first", path.string(),
                              channel.name, image.width, image.height, image.channels, first.width, first.height));
    }
    if (channel.name.empty() || !names.insert(channel.name).second) {
      throw Error(fmt::format("{}: channel name \"{}\" is empty or there twice", path.string(), channel.name));
    }
  }
  requirePixels(path, channels.front().image);
}

/// Collects what the module reads.
struct Reading {
  ExrPicture picture;
  int width = 0;
  int height = 0;
  std::vector<float> pixels;
  std::exception_ptr failure;  ///< C callbacks cannot throw

  static Reading& of(void* context) { return *static_cast<Reading*>(context); }
};

void addAttribute(void* context, const char* name, const char* value) try {
  Reading::of(context).picture.metadata.emplace_back(name, value);
} catch (...) {
  Reading::of(context).failure = std::current_exception();
}

/// 2 GiB of floats: the largest picture of this framework (16384 x 16384) of two channels, or 60 channels of 8 megapixels.
constexpr std::int64_t kMostFloats = std::int64_t{1} << 29;

float* takePixels(void* context, int width, int height, int channels, const char* const* names) try {
  Reading& reading = Reading::of(context);
  if (width < 1 || height < 1 || channels < 1 || std::int64_t{width} * height > kMostFloats / channels) return nullptr;
  reading.width = width;
  reading.height = height;
  for (int c = 0; c < channels; ++c) reading.picture.channels.push_back({names[c], Image(width, height)});
  reading.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        static_cast<std::size_t>(channels));
  return reading.pixels.data();
} catch (...) {
  Reading::of(context).failure = std::current_exception();
  return nullptr;
}

}  // namespace

float encodeSrgb(float linear) {
  const float value = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;  // NaN compares false
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

void writePng(const std::filesystem::path& path, const Image& linear) {
  requireExtension(path, ".png");
  requirePixels(path, linear);
  if (linear.channels != 1 && linear.channels != 3) {
    throw Error(fmt::format("{}: the picture has {} channels; allowed: 1 or 3", path.string(), linear.channels));
  }
  std::vector<std::uint8_t> bytes(linear.data.size());
  std::transform(linear.data.begin(), linear.data.end(), bytes.begin(),
                 [](float value) { return static_cast<std::uint8_t>(std::lround(255.0f * encodeSrgb(value))); });
  writePicture(path, {linear.width, linear.height, linear.channels, bytes.data()});
}

void writeExr(const std::filesystem::path& path, const std::vector<NamedChannel>& channels, const Metadata& metadata) {
  requireExtension(path, ".exr");
  requireChannels(path, channels);
  const Image& first = channels.front().image;
  const std::size_t stride = channels.size();
  std::vector<float> pixels(first.pixels() * stride);
  for (std::size_t c = 0; c < stride; ++c) {
    for (std::size_t i = 0; i < first.pixels(); ++i) pixels[i * stride + c] = channels[c].image.data[i];
  }
  Content content{first.width, first.height, static_cast<int>(stride), pixels.data()};
  for (const NamedChannel& channel : channels) content.channelNames.push_back(channel.name.c_str());
  for (const auto& [name, value] : metadata) {
    content.attributeNames.push_back(name.c_str());
    content.attributeValues.push_back(value.c_str());
  }
  writePicture(path, content);
}

ExrPicture readExr(const std::filesystem::path& path) {
  requireExtension(path, ".exr");
  Reading reading;
  const GnomonImageSink sink{&reading, addAttribute, takePixels};
  Message message{};
  const int failed = module().read(path.c_str(), &sink, message.data(), message.size());
  if (reading.failure) std::rethrow_exception(reading.failure);
  if (failed != 0) throw Error(fmt::format("{}: cannot read the picture: {}", path.string(), message.data()));
  const std::size_t stride = reading.picture.channels.size();
  for (std::size_t c = 0; c < stride; ++c) {
    Image& image = reading.picture.channels[c].image;
    for (std::size_t i = 0; i < image.pixels(); ++i) image.data[i] = reading.pixels[i * stride + c];
  }
  return std::move(reading.picture);
}

bool ExrPicture::has(const std::string& name) const {
  return std::any_of(channels.begin(), channels.end(), [&](const NamedChannel& channel) { return channel.name == name; });
}

const Image& ExrPicture::channel(const std::string& name) const {
  std::vector<std::string> names;
  for (const NamedChannel& channel : channels) {
    if (channel.name == name) return channel.image;
    names.push_back(channel.name);
  }
  throw Error(fmt::format("the picture has no channel \"{}\"; it has {}", name, fmt::join(names, ", ")));
}

std::string ExrPicture::metadataValue(const std::string& key) const {
  for (const auto& [name, value] : metadata) {
    if (name == key) return value;
  }
  return {};
}

}  // namespace gnomon
