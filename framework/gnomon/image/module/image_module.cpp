// The only file that knows OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "gnomon/image/image_module.h"

namespace {

bool isFloatFormat(const std::string& path) {
  return path.size() > 4 && path.compare(path.size() - 4, 4, ".exr") == 0;
}

OIIO::ImageSpec specOf(const GnomonImageSource& source) {
  const bool isFloat = isFloatFormat(source.path);
  OIIO::ImageSpec spec(source.width, source.height, source.channels, isFloat ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  if (source.channelNames != nullptr) spec.channelnames.assign(source.channelNames, source.channelNames + source.channels);
  if (isFloat) {
    spec.attribute("compression", "zip");
    // The library would write the time of day, and no two files would be alike.
    spec.attribute("DateTime", "2000:01:01 00:00:00");
  } else {
    spec.attribute("oiio:ColorSpace", "sRGB");
  }
  for (int i = 0; i < source.attributes; ++i) spec.attribute(source.attributeNames[i], source.attributeValues[i]);
  return spec;
}

void write(const GnomonImageSource& source) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(source.path);
  if (!output) throw std::runtime_error(OIIO::geterror());
  const OIIO::ImageSpec spec = specOf(source);
  if (!output->open(source.path, spec) || !output->write_image(spec.format, source.pixels) || !output->close()) {
    throw std::runtime_error(output->geterror());
  }
}

void read(const char* path, const GnomonImageSink& sink) {
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input) throw std::runtime_error(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    if (attribute.type() == OIIO::TypeDesc::STRING)
      sink.attribute(sink.context, attribute.name().c_str(), attribute.get_ustring().c_str());
  }
  std::vector<const char*> names;
  for (const std::string& name : spec.channelnames) names.push_back(name.c_str());
  float* pixels = sink.pixels(sink.context, spec.width, spec.height, spec.nchannels, names.data());
  if (pixels == nullptr) throw std::runtime_error("more pixels than can be taken");
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels)) throw std::runtime_error(input->geterror());
}

/// Runs `action`; what it throws becomes a message.
template <class Action>
int guarded(char* error, unsigned long errorSize, const Action& action) {
  try {
    action();
    return 0;
  } catch (const std::exception& failure) {
    std::snprintf(error, errorSize, "%s", failure.what());
  } catch (...) {
    std::snprintf(error, errorSize, "unknown failure");
  }
  return 1;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int gnomon_image_write(const GnomonImageSource* source, char* error,
                                                                         unsigned long errorSize) {
  return guarded(error, errorSize, [&] { write(*source); });
}

extern "C" __attribute__((visibility("default"))) int gnomon_image_read(const char* path, const GnomonImageSink* sink,
                                                                        char* error, unsigned long errorSize) {
  return guarded(error, errorSize, [&] { read(path, *sink); });
}
